#include "mesh/shapes/shapes.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <boost/math/tools/roots.hpp>

#include "core/units.h"
#include "mesh/shapes/analytic.h"
#include "mesh/shapes/make_checks.h"
#include "mesh/shapes/pipe_star.h"

namespace meshwind {
namespace {

// Close to folding the blend's curvature has no bound: so near it may come.
constexpr double kNearFolding = 0.9;

// Blend radius at which the ball's path, where it passes the crotch, curves as tightly as the ball:
// the blend would fold there. With b = branch + blend, a = run + blend its radius of curvature is
// b / sqrt(1 + (b / a)^2).
double folding_blend_mm(const TeeShape& shape) {
    const auto excess = [&](double blend) {
        const double b = blend / (shape.branch_radius_mm + blend);
        const double a = blend / (shape.run_radius_mm + blend);
        return a * a + b * b - 1.0;
    };
    // At ten times the run radius the sum of squares is at least 2 (10 / 11)^2 > 1.
    const auto [low, high] = boost::math::tools::bisect(
        excess, 0.0, 10.0 * shape.run_radius_mm, boost::math::tools::eps_tolerance<double>(30));
    return 0.5 * (low + high);
}

// The blend's radius over the radius of curvature of the ball's path, towards the blend: where it
// is 1 the blend folds. By differences, for branches that lean.
double fold(const TeeShape& shape) {
    constexpr int kPlaces = 720;
    constexpr int kAcross = 8;
    constexpr double kStep_rad = 1e-3;
    // Where run and branch touch at less than that the blend is as good as gone.
    constexpr double kGone_rad = 0.1;
    double worst = 0.0;
    for (int i = 0; i < kPlaces; ++i) {
        const double psi = 2.0 * kPi * i / kPlaces;
        const BlendArc arc = blend_arc(shape, psi);
        if ((arc.to_run - arc.to_branch).norm() < kGone_rad) {
            continue;
        }
        const Eigen::Vector3d before = tee_spine_mm(shape, psi - kStep_rad);
        const Eigen::Vector3d after = tee_spine_mm(shape, psi + kStep_rad);
        const Eigen::Vector3d along = (after - before).normalized();
        Eigen::Vector3d bend = after - 2.0 * arc.centre_mm + before;
        bend -= bend.dot(along) * along;
        bend *= 4.0 / (after - before).squaredNorm();
        for (int k = 0; k <= kAcross; ++k) {
            const Eigen::Vector3d way = arc.direction(static_cast<double>(k) / kAcross);
            worst = std::max(worst, shape.blend_radius_mm * bend.dot(way));
        }
    }
    return worst;
}

// A blend in a crotch between equal pipes curves along the crotch by pipe and ball together times
// the sine of half the angle between them.
// \param lengths names of the pipes' lengths
void check_star(const PipeStar& star, std::initializer_list<const char*> lengths) {
    double narrowest = kPi;
    for (std::size_t k = 0; k < star.pipes.size(); ++k) {
        narrowest = std::min(narrowest, star.angle_after(k));
    }
    const double share = kNearFolding * std::sin(0.5 * narrowest);
    const double limit = share / (1.0 - share) * star.pipe_radius_mm;
    require(star.blend_radius_mm <= limit, "make.blend_too_large", "blend-radius",
            star.blend_radius_mm, "at most, lest the blend fold,", limit);
    std::size_t k = 0;
    for (const char* const length : lengths) {
        const double end = star.blend_end_mm(k);
        require(star.pipes[k].length_mm > end, "make.leg_too_short", length,
                star.pipes[k].length_mm, "more than what the blend takes of it,", end);
        ++k;
    }
}

}  // namespace

double TeeShape::blend_end_on_run_mm() const {
    return (branch_radius_mm + blend_radius_mm +
            (run_radius_mm + blend_radius_mm) * std::sin(lean_rad)) /
           std::cos(lean_rad);
}

double TeeShape::blend_end_on_branch_mm() const {
    return (run_radius_mm + blend_radius_mm +
            (branch_radius_mm + blend_radius_mm) * std::sin(lean_rad)) /
           std::cos(lean_rad);
}

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
    require_not_negative("upper-opening-radius", upper_opening_mm());
    require(upper_opening_mm() < radius_mm, "make.opening_too_large", "upper-opening-radius",
            upper_opening_mm(), "less than the radius", radius_mm);
}

IsotensoidDesign IsotensoidShape::dome() const {
    return {radius_mm, design_radius_mm > 0.0 ? design_radius_mm : opening_radius_mm,
            stiffness_ratio};
}

void IsotensoidShape::validate() const {
    require_positive("radius", radius_mm);
    require_positive("cylinder-length", cylinder_length_mm);
    require_positive("opening-radius", opening_radius_mm);
    require_not_negative("design-radius", design_radius_mm);
    require(opening_radius_mm < radius_mm, "make.opening_too_large", "opening-radius",
            opening_radius_mm, "less than the radius", radius_mm);
    const double least = IsotensoidDome(dome()).least_radius_mm();
    require(opening_radius_mm >= least, "make.opening_too_small", "opening-radius",
            opening_radius_mm, "at least, for this design-radius, where the dome turns back,",
            least);
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

void WyeShape::validate() const {
    require_positive("pipe-radius", pipe_radius_mm);
    require_positive("blend-radius", blend_radius_mm);
    require_positive("stem-length", stem_length_mm);
    require_positive("arm-length", arm_length_mm);
    require_positive("angle", angle_rad);
    // The arms lie against each other below the one, and one is the other's run beyond the other.
    require(angle_rad >= kPi / 6.0, "make.arms_angle", "angle", deg_from_rad(angle_rad),
            "at least, in degrees,", 30.0);
    require(angle_rad <= 5.0 * kPi / 6.0, "make.arms_angle", "angle", deg_from_rad(angle_rad),
            "at most, in degrees,", 150.0);
    check_star(star_of(*this), {"stem-length", "arm-length", "arm-length"});
}

void CrossShape::validate() const {
    require_positive("pipe-radius", pipe_radius_mm);
    require_positive("blend-radius", blend_radius_mm);
    require_positive("run-length", run_length_mm);
    require_positive("branch-length", branch_length_mm);
    const char* const half = "half of run-length";
    check_star(star_of(*this), {half, "branch-length", half, "branch-length"});
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
    const double limit = kNearFolding * folding_blend_mm(*this);
    require(blend_radius_mm <= limit, "make.blend_too_large", "blend-radius", blend_radius_mm,
            "at most, lest the blend fold,", limit);
    require_not_negative("lean", lean_rad);
    require(lean_rad <= kPi / 3.0, "make.lean_too_large", "lean", deg_from_rad(lean_rad),
            "at most, in degrees,", 60.0);
    require(2.0 * blend_end_on_run_mm() < run_length_mm, "make.lean_too_large", "run-length",
            run_length_mm, "more, for so much lean, than", 2.0 * blend_end_on_run_mm());
    require(blend_end_on_branch_mm() < branch_length_mm, "make.lean_too_large", "branch-length",
            branch_length_mm, "more, for so much lean, than", blend_end_on_branch_mm());
    if (lean_rad > 0.0) {
        const double taken = fold(*this);
        require(taken <= kNearFolding, "make.blend_too_large", "blend-radius", blend_radius_mm,
                "less, lest the blend fold, perhaps", kNearFolding * blend_radius_mm / taken);
    }
}

}  // namespace meshwind
