#include "mesh/shapes.h"

#include "mesh/make_checks.h"

namespace meshwind {

void CylinderShape::validate() const {
    require_positive("radius", radius_mm);
    require_positive("length", length_mm);
}

void ConeShape::validate() const {
    require_positive("radius1", radius1_mm);
    require_positive("radius2", radius2_mm);
    require_positive("length", length_mm);
}

void VesselShape::validate() const {
    require_positive("radius", radius_mm);
    require_positive("cylinder-length", cylinder_length_mm);
    require_positive("dome-height", dome_height_mm);
    require_not_negative("opening-radius", opening_radius_mm);
    require(opening_radius_mm < radius_mm, "make.opening_too_large", "opening-radius",
            opening_radius_mm, "less than the radius", radius_mm);
}

void ElbowShape::validate() const {
    require_positive("pipe-radius", pipe_radius_mm);
    require_positive("bend-radius", bend_radius_mm);
    require_positive("angle", angle_rad);
    require_not_negative("leg1", leg1_mm);
    require_not_negative("leg2", leg2_mm);
    require(bend_radius_mm > pipe_radius_mm, "make.bend_too_tight", "bend-radius", bend_radius_mm,
            "more than the pipe radius", pipe_radius_mm);
    require(angle_rad <= kPi, "make.angle_too_large", "angle", deg_from_rad(angle_rad),
            "at most, in degrees,", 180.0);
}

void CombinationShape::validate() const {
    require_positive("radius1", radius1_mm);
    require_positive("length1", length1_mm);
    require_positive("cone-length", cone_length_mm);
    require_positive("radius2", radius2_mm);
    require_positive("length2", length2_mm);
    require_positive("dome-height", dome_height_mm);
    require_not_negative("opening-radius", opening_radius_mm);
    require(opening_radius_mm < radius2_mm, "make.opening_too_large", "opening-radius",
            opening_radius_mm, "less than radius2", radius2_mm);
}

void TorusShape::validate() const {
    require_positive("ring-radius", ring_radius_mm);
    require_positive("tube-radius", tube_radius_mm);
    require_positive("angle", angle_rad);
    require(ring_radius_mm > tube_radius_mm, "make.bend_too_tight", "ring-radius", ring_radius_mm,
            "more than the tube radius", tube_radius_mm);
    require(angle_rad <= 2.0 * kPi, "make.angle_too_large", "angle", deg_from_rad(angle_rad),
            "at most, in degrees,", 360.0);
}

void EllipsoidShape::validate() const {
    require_positive("equator-radius", equator_radius_mm);
    require_positive("pole-radius", pole_radius_mm);
}

void TeeShape::validate() const {
    require_positive("run-radius", run_radius_mm);
    require_positive("branch-radius", branch_radius_mm);
    require_positive("blend-radius", blend_radius_mm);
    require_positive("run-length", run_length_mm);
    require_positive("branch-length", branch_length_mm);
    require(branch_radius_mm <= run_radius_mm, "make.branch_too_wide", "branch-radius",
            branch_radius_mm, "at most the run radius", run_radius_mm);
    require(blend_radius_mm < 0.5 * run_length_mm - branch_radius_mm, "make.blend_too_large",
            "blend-radius", blend_radius_mm,
            "less than half the run length less the branch radius:",
            0.5 * run_length_mm - branch_radius_mm);
    require(blend_radius_mm < branch_length_mm - run_radius_mm, "make.blend_too_large",
            "blend-radius", blend_radius_mm,
            "less than the branch length less the run radius:", branch_length_mm - run_radius_mm);
}

}  // namespace meshwind
