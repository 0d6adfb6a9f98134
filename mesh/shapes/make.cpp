#include "mesh/shapes/make.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "mesh/shapes/analytic.h"
#include "mesh/shapes/make_checks.h"
#include "mesh/shapes/make_parts.h"
#include "mesh/shapes/make_walls.h"
#include "mesh/shapes/pipe_star.h"
#include "mesh/shapes/remesh.h"

namespace meshwind {
namespace {

// What of each shape limits edge and wall: the least radius or length a mesh must still show.
double least_size(const CylinderShape& shape) {
    return std::min(shape.radius_mm, shape.length_mm);
}

double least_size(const ConeShape& shape) {
    return std::min({shape.radius1_mm, shape.radius2_mm, shape.length_mm});
}

// A closed opening is no limit.
double opening_limit(double opening, double otherwise) {
    return opening > 0.0 ? std::min(opening, otherwise) : otherwise;
}

double least_size(const VesselShape& shape) {
    const double openings = opening_limit(shape.opening_radius_mm,
                                          opening_limit(shape.upper_opening_mm(), shape.radius_mm));
    return std::min({openings, shape.cylinder_length_mm, shape.dome_height_mm,
                     shape.radius_mm - shape.opening_radius_mm,
                     shape.radius_mm - shape.upper_opening_mm()});
}

double least_size(const IsotensoidShape& shape) {
    return std::min({shape.radius_mm, shape.cylinder_length_mm, shape.opening_radius_mm,
                     shape.radius_mm - shape.opening_radius_mm});
}

double least_size(const CombinationShape& shape) {
    return opening_limit(shape.opening_radius_mm,
                         std::min({shape.radius1_mm, shape.length1_mm, shape.cone_length_mm,
                                   shape.radius2_mm, shape.length2_mm, shape.dome_height_mm,
                                   shape.radius2_mm - shape.opening_radius_mm}));
}

double least_size(const ElbowShape& shape) {
    const double inside = (shape.bend_radius_mm - shape.pipe_radius_mm) * shape.angle_rad;
    const double legs = opening_limit(shape.leg1_mm, opening_limit(shape.leg2_mm, inside));
    return std::min(shape.pipe_radius_mm, legs);
}

double least_size(const TorusShape& shape) {
    return std::min(shape.tube_radius_mm,
                    (shape.ring_radius_mm - shape.tube_radius_mm) * shape.angle_rad);
}

double least_size(const EllipsoidShape& shape) {
    return std::min(shape.equator_radius_mm, shape.pole_radius_mm);
}

double least_size(const TeeShape& shape) {
    // Between blend and rims there must be room for two rows.
    const double blend_to_rim = std::min(0.5 * shape.run_length_mm - shape.blend_end_on_run_mm(),
                                         shape.branch_length_mm - shape.blend_end_on_branch_mm());
    return std::min(0.5 * shape.branch_radius_mm, 0.5 * blend_to_rim);
}

double least_size(const PipeStar& star) {
    double least = 0.5 * star.pipe_radius_mm;
    for (std::size_t k = 0; k < star.pipes.size(); ++k) {
        least = std::min(least, 0.5 * (star.pipes[k].length_mm - star.blend_end_mm(k)));
    }
    return least;
}

double least_size(const WyeShape& shape) {
    return least_size(star_of(shape));
}

double least_size(const CrossShape& shape) {
    return least_size(star_of(shape));
}

// Rough area of the outer surface, enough to foresee the number of triangles.
double rough_area(const CylinderShape& shape) {
    return 2.0 * kPi * shape.radius_mm * shape.length_mm;
}

double rough_area(const ConeShape& shape) {
    return kPi * (shape.radius1_mm + shape.radius2_mm) *
           std::hypot(shape.radius1_mm - shape.radius2_mm, shape.length_mm);
}

double rough_area(const VesselShape& shape) {
    return 2.0 * kPi * shape.radius_mm *
           (shape.cylinder_length_mm + shape.radius_mm + 2.0 * shape.dome_height_mm);
}

// The domes are less high than half a sphere.
double rough_area(const IsotensoidShape& shape) {
    return 2.0 * kPi * shape.radius_mm * (shape.cylinder_length_mm + 2.0 * shape.radius_mm);
}

double rough_area(const CombinationShape& shape) {
    const double radius = std::max(shape.radius1_mm, shape.radius2_mm);
    return 2.0 * kPi * radius *
           (shape.length1_mm + shape.cone_length_mm + shape.length2_mm + shape.dome_height_mm +
            radius);
}

double rough_area(const ElbowShape& shape) {
    return 2.0 * kPi * shape.pipe_radius_mm *
           (shape.leg1_mm + shape.leg2_mm + shape.bend_radius_mm * shape.angle_rad);
}

double rough_area(const TorusShape& shape) {
    return 2.0 * kPi * shape.tube_radius_mm * shape.ring_radius_mm * shape.angle_rad;
}

double rough_area(const EllipsoidShape& shape) {
    return 4.0 * kPi * shape.equator_radius_mm *
           std::max(shape.equator_radius_mm, shape.pole_radius_mm);
}

double rough_area(const TeeShape& shape) {
    return 2.0 * kPi *
           (shape.run_radius_mm * shape.run_length_mm +
            shape.branch_radius_mm * shape.branch_length_mm);
}

double rough_area(const WyeShape& shape) {
    return 2.0 * kPi * shape.pipe_radius_mm * (shape.stem_length_mm + 2.0 * shape.arm_length_mm);
}

double rough_area(const CrossShape& shape) {
    return 2.0 * kPi * shape.pipe_radius_mm * (shape.run_length_mm + 2.0 * shape.branch_length_mm);
}

template <class Shape>
void check_edge(const Shape& shape, double edge_mm) {
    require_positive("edge", edge_mm);
    const double limit = least_size(shape);
    require(edge_mm <= limit, "make.edge_too_large", "edge", edge_mm, "at most", limit);
    // Ten million triangles need about 3 GB while they are made and fill a 500 MB STL file.
    constexpr double kMaxTriangles = 1e7;
    const double least = std::sqrt(rough_area(shape) / (kMaxTriangles * std::sqrt(3.0) / 4.0));
    require(edge_mm >= least, "make.edge_too_small", "edge", edge_mm,
            "at least, for ten million triangles,", least);
}

// The wall's inner side.
CylinderShape inside(CylinderShape shape, double wall) {
    shape.radius_mm -= wall;
    return shape;
}

ConeShape inside(ConeShape shape, double wall) {
    const double slope = (shape.radius1_mm - shape.radius2_mm) / shape.length_mm;
    const double shift = wall * std::sqrt(1.0 + slope * slope);
    shape.radius1_mm -= shift;
    shape.radius2_mm -= shift;
    return shape;
}

VesselShape inside(VesselShape shape, double wall) {
    shape.radius_mm -= wall;
    shape.dome_height_mm -= wall;
    return shape;
}

IsotensoidShape inside(IsotensoidShape shape, double wall) {
    shape.radius_mm -= wall;
    return shape;
}

CombinationShape inside(CombinationShape shape, double wall) {
    // Sharp rings move along the bisector of their two lines.
    const double half_angle =
        0.5 * std::atan2(shape.radius1_mm - shape.radius2_mm, shape.cone_length_mm);
    const double shift = wall * std::tan(half_angle);
    shape.radius1_mm -= wall;
    shape.radius2_mm -= wall;
    shape.length1_mm -= shift;
    shape.length2_mm += shift;
    shape.dome_height_mm -= wall;
    return shape;
}

ElbowShape inside(ElbowShape shape, double wall) {
    shape.pipe_radius_mm -= wall;
    return shape;
}

TorusShape inside(TorusShape shape, double wall) {
    shape.tube_radius_mm -= wall;
    return shape;
}

EllipsoidShape inside(EllipsoidShape shape, double wall) {
    shape.equator_radius_mm -= wall;
    shape.pole_radius_mm -= wall;
    return shape;
}

TeeShape inside(TeeShape shape, double wall) {
    shape.run_radius_mm -= wall;
    shape.branch_radius_mm -= wall;
    shape.blend_radius_mm += wall;
    return shape;
}

WyeShape inside(WyeShape shape, double wall) {
    shape.pipe_radius_mm -= wall;
    shape.blend_radius_mm += wall;
    return shape;
}

CrossShape inside(CrossShape shape, double wall) {
    shape.pipe_radius_mm -= wall;
    shape.blend_radius_mm += wall;
    return shape;
}

ShapeFoot foot(const ElbowShape& shape, const Eigen::Vector3d& p) {
    return elbow_foot(shape, p);
}

ShapeFoot foot(const TorusShape& shape, const Eigen::Vector3d& p) {
    return torus_foot(shape, p);
}

ShapeFoot foot(const TeeShape& shape, const Eigen::Vector3d& p) {
    return tee_foot(shape, p);
}

ShapeFoot foot(const PipeStar& star, const Eigen::Vector3d& p) {
    return star_foot(star, p);
}

ShapeFoot foot(const Profile& profile, const Eigen::Vector3d& p) {
    return profile_foot(profile, p);
}

template <class Surface>
TriangleSoup wall_on(const Surface& surface, const MakeOptions& options, std::uint64_t seed) {
    MadeWall wall = wall_of(surface, options.edge_mm);
    if (!options.irregular) {
        return std::move(wall.soup);
    }
    const auto project = [&](const Eigen::Vector3d& p) { return foot(surface, p).point_mm; };
    return roughen_onto(wall.soup, project, wall.sharp, {.edge_mm = options.edge_mm, .seed = seed});
}

template <class Shape>
TriangleSoup wall_with(const Shape& shape, const MakeOptions& options, std::uint64_t seed) {
    if constexpr (requires { profile_of(shape); }) {
        return wall_on(profile_of(shape), options, seed);
    } else if constexpr (requires { star_of(shape); }) {
        return wall_on(star_of(shape), options, seed);
    } else {
        return wall_on(shape, options, seed);
    }
}

template <class Shape>
TriangleSoup make(const Shape& shape, const MakeOptions& options) {
    shape.validate();
    check_edge(shape, options.edge_mm);
    TriangleSoup outer = wall_with(shape, options, options.seed);
    if (!options.solid) {
        return outer;
    }
    require_positive("wall", options.wall_mm);
    const Shape inner = inside(shape, options.wall_mm);
    const double least = least_size(inner);
    require(least >= options.edge_mm, "make.wall_too_thick", "wall", options.wall_mm,
            "so thin that what it leaves inside is at least one edge, not", least);
    inner.validate();
    // The inner wall must not repeat the outer one's random numbers.
    constexpr std::uint64_t kInnerSeed = 0x9e3779b97f4a7c15U;
    return shell_between(outer, wall_with(inner, options, options.seed ^ kInnerSeed));
}

}  // namespace

TriangleSoup make_cylinder(const CylinderShape& shape, const MakeOptions& options) {
    return make(shape, options);
}

TriangleSoup make_cone(const ConeShape& shape, const MakeOptions& options) {
    return make(shape, options);
}

TriangleSoup make_vessel(const VesselShape& shape, const MakeOptions& options) {
    return make(shape, options);
}

TriangleSoup make_isotensoid(const IsotensoidShape& shape, const MakeOptions& options) {
    return make(shape, options);
}

TriangleSoup make_elbow(const ElbowShape& shape, const MakeOptions& options) {
    return make(shape, options);
}

TriangleSoup make_tee(const TeeShape& shape, const MakeOptions& options) {
    return make(shape, options);
}

TriangleSoup make_wye(const WyeShape& shape, const MakeOptions& options) {
    return make(shape, options);
}

TriangleSoup make_cross(const CrossShape& shape, const MakeOptions& options) {
    return make(shape, options);
}

TriangleSoup make_combination(const CombinationShape& shape, const MakeOptions& options) {
    return make(shape, options);
}

TriangleSoup make_torus(const TorusShape& shape, const MakeOptions& options) {
    return make(shape, options);
}

TriangleSoup make_ellipsoid(const EllipsoidShape& shape, const MakeOptions& options) {
    return make(shape, options);
}

}  // namespace meshwind
