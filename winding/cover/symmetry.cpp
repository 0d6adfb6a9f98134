#include "winding/cover/symmetry.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/small_linear.h"
#include "geodesic/trace.h"

namespace meshwind {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Points of the wall that are looked at: a part of a hundredth of the wall that has no counterpart
// is missed once in e^5 times.
constexpr std::size_t kPoints = 500;

// Combinations of planes that are used: a body of revolution has no end of them.
constexpr std::size_t kMaxMaps = 15;

// Two directions closer than this, in rad, are one: they come from fits to meshes.
constexpr double kSame = 0.03;

// An image further from the wall than this is none, mm.
constexpr double kFar_mm = 1e6;

Matrix3d mirror(const Vector3d& normal) {
    return Matrix3d::Identity() - 2.0 * normal * normal.transpose();
}

// A mirror turns with twice its normal.
bool same(const Matrix3d& a, const Matrix3d& b) {
    return (a - b).norm() < 3.0 * kSame;
}

bool is_new(const std::vector<Vector3d>& directions, const Vector3d& direction) {
    return std::none_of(directions.begin(), directions.end(), [&](const Vector3d& known) {
        return known.cross(direction).norm() < kSame;
    });
}

void add_direction(std::vector<Vector3d>& directions, const Vector3d& direction) {
    if (direction.norm() > kSame && is_new(directions, direction.normalized())) {
        directions.emplace_back(direction.normalized());
    }
}

// The wall's area, its centre, and how it is spread about it.
struct Masses {
    double area = 0.0;
    Vector3d centre = Vector3d::Zero();
    Matrix3d spread = Matrix3d::Zero();

    explicit Masses(const Surface& surface) {
        for (const auto& [a, b, c] : surface.face) {
            const auto corner = [&](std::int32_t v) {
                return surface.position_mm[static_cast<std::size_t>(v)];
            };
            const Vector3d middle = (corner(a) + corner(b) + corner(c)) / 3.0;
            const double weight = 0.5 * (corner(b) - corner(a)).cross(corner(c) - corner(a)).norm();
            area += weight;
            centre += weight * middle;
            spread += weight * middle * middle.transpose();
        }
        centre /= area;
        spread = spread / area - centre * centre.transpose();
    }
};

// Normals that planes may have.
std::vector<Vector3d> likely_normals(const Mandrel& mandrel, const Matrix3d& spread) {
    const PrincipalAxes<3> principal = principal_axes(spread);
    std::vector<Vector3d> axes;  // those of the rims are known best
    for (const Rim& rim : mandrel.rims) {
        add_direction(axes, rim.axis);
    }
    for (int i = 0; i < 3; ++i) {
        add_direction(axes, principal.vectors.col(i));
    }
    std::vector<Vector3d> normals = axes;
    for (const Vector3d& a : axes) {
        for (const Vector3d& b : axes) {
            add_direction(normals, a.cross(b));
            add_direction(normals, a.cross(b).cross(a));
        }
    }
    return normals;
}

}  // namespace

MirrorImages::MirrorImages(const Mandrel& mandrel, const CoverageSamples& samples,
                           double tolerance_mm)
    : surface_(mandrel.surface),
      wall_([&] {
          const TriangleSoup soup{mandrel.surface.position_mm, mandrel.surface.face};
          return RayQuery({&soup, 1});
      }()),
      centre_mm_(Vector3d::Zero()) {
    const Masses masses(surface_);
    centre_mm_ = masses.centre;
    const std::vector<Vector3d>& all = samples.position_mm;
    std::vector<Vector3d> some;
    const std::size_t count = std::min(kPoints, all.size());
    for (std::size_t i = 0; i < count; ++i) {
        some.push_back(all[i * all.size() / count]);
    }
    for (const Vector3d& normal : likely_normals(mandrel, masses.spread)) {
        if (keeps_the_wall(mirror(normal), some, tolerance_mm)) {
            add_with_products(mirror(normal));
        }
    }
}

bool MirrorImages::keeps_the_wall(const Matrix3d& map, std::span<const Vector3d> points,
                                  double tolerance_mm) const {
    return std::all_of(points.begin(), points.end(), [&](const Vector3d& point) {
        return wall_.closest(centre_mm_ + map * (point - centre_mm_), tolerance_mm).part >= 0;
    });
}

void MirrorImages::add_with_products(const Matrix3d& map) {
    std::vector<Matrix3d> found{map};
    for (const Matrix3d& known : maps_) {
        found.emplace_back(map * known);
    }
    for (const Matrix3d& image : found) {
        const bool known = same(image, Matrix3d::Identity()) ||
                           std::any_of(maps_.begin(), maps_.end(),
                                       [&](const Matrix3d& other) { return same(image, other); });
        if (!known && maps_.size() < kMaxMaps) {
            maps_.push_back(image);
        }
    }
}

Candidate MirrorImages::of(const Candidate& candidate, std::size_t which) const {
    const Matrix3d& map = maps_[which];
    const Vector3d place = map * (position_mm(surface_, candidate.seed) - centre_mm_);
    const ClosestPoint nearest = wall_.closest(centre_mm_ + place, kFar_mm);
    const SurfacePoint seed{nearest.face, nearest.bary};
    const Vector3d tangent = map * direction_of(surface_, candidate);
    // A mirror image leans to the other side of its direction of travel.
    const double side = map.determinant();
    return {seed, direction_angle(smooth_normal(surface_, seed), tangent),
            side * candidate.slip_ratio, side * candidate.more_behind};
}

}  // namespace meshwind
