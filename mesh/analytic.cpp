#include "mesh/analytic.h"

#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <boost/math/tools/toms748_solve.hpp>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Spine {
    double run_mm;     // radius of the run's offset cylinder
    double branch_mm;  // radius of the branch's offset cylinder, <= run_mm

    explicit Spine(const TeeShape& shape)
        : run_mm(shape.run_radius_mm + shape.blend_radius_mm),
          branch_mm(shape.branch_radius_mm + shape.blend_radius_mm) {}

    // x^2 = run^2 - branch^2 sin^2, written without cancellation for equal radii.
    [[nodiscard]] double x(double psi) const {
        const double c = branch_mm * std::cos(psi);
        return std::sqrt((run_mm - branch_mm) * (run_mm + branch_mm) + c * c);
    }
    [[nodiscard]] Vector3d point(double psi) const {
        return {x(psi), branch_mm * std::sin(psi), branch_mm * std::cos(psi)};
    }
    // In the quarter 0 <= psi <= pi/2. Equal radii have a kink at pi/2; the limit from below holds
    // there.
    [[nodiscard]] Vector3d derivative(double psi) const {
        const double s = branch_mm * std::sin(psi);
        const double c = branch_mm * std::cos(psi);
        const double x_mm = x(psi);
        return {x_mm > 0.0 ? -s * c / x_mm : -s, c, -s};
    }
};

// Spine parameter nearest to a point with y >= 0 and z >= 0, in [0, pi/2].
double nearest_psi(const Spine& spine, const Vector3d& point) {
    // The spine's quarter bends little; 16 steps bracket the nearest minimum.
    constexpr int kSteps = 16;
    const auto slope = [&](double psi) {
        return (spine.point(psi) - point).dot(spine.derivative(psi));
    };
    int best = 0;
    double best_distance = std::numeric_limits<double>::max();
    for (int i = 0; i <= kSteps; ++i) {
        const double distance = (spine.point(0.5 * kPi * i / kSteps) - point).squaredNorm();
        if (distance < best_distance) {
            best_distance = distance;
            best = i;
        }
    }
    const double low = 0.5 * kPi * std::max(best - 1, 0) / kSteps;
    const double high = 0.5 * kPi * std::min(best + 1, kSteps) / kSteps;
    const double slope_low = slope(low);
    const double slope_high = slope(high);
    if (slope_low >= 0.0) {
        return low;
    }
    if (slope_high <= 0.0) {
        return high;
    }
    std::uintmax_t iterations = 100;
    const auto [a, b] = boost::math::tools::toms748_solve(
        slope, low, high, slope_low, slope_high, boost::math::tools::eps_tolerance<double>(52),
        iterations);
    return 0.5 * (a + b);
}

ShapeFoot run_foot(const TeeShape& shape, const Vector3d& point) {
    const double radius = std::hypot(point.x(), point.y());
    const Vector3d normal = Vector3d(point.x(), point.y(), 0.0) / radius;
    const Vector3d foot = shape.run_radius_mm * normal + Vector3d(0.0, 0.0, point.z());
    return {foot, normal, radius - shape.run_radius_mm, ShapePart::Run};
}

ShapeFoot branch_foot(const TeeShape& shape, const Vector3d& point) {
    const double radius = std::hypot(point.y(), point.z());
    const Vector3d normal = Vector3d(0.0, point.y(), point.z()) / radius;
    const Vector3d foot = shape.branch_radius_mm * normal + Vector3d(point.x(), 0.0, 0.0);
    return {foot, normal, radius - shape.branch_radius_mm, ShapePart::Branch};
}

ShapeFoot blend_foot(const TeeShape& shape, const Vector3d& point) {
    const Vector3d sign(1.0, std::copysign(1.0, point.y()), std::copysign(1.0, point.z()));
    const Spine spine(shape);
    const Vector3d folded = point.cwiseProduct(sign);
    const Vector3d centre = spine.point(nearest_psi(spine, folded)).cwiseProduct(sign);
    const double distance = (centre - point).norm();
    const Vector3d normal = (centre - point) / distance;
    return {centre - shape.blend_radius_mm * normal, normal, shape.blend_radius_mm - distance,
            ShapePart::Blend};
}

}  // namespace

Vector3d tee_spine_mm(const TeeShape& shape, double psi_rad) {
    return Spine(shape).point(psi_rad);
}

ShapeFoot tee_foot(const TeeShape& shape, const Vector3d& point_mm) {
    // The normals along a contact curve pass through the spine, so seen radially from its own axis
    // a point belongs to a cylinder exactly where that cylinder's offset lies outside the other's.
    const Spine spine(shape);
    const Vector2d around_run = spine.run_mm * point_mm.head<2>().normalized();
    const Vector2d around_branch = spine.branch_mm * point_mm.tail<2>().normalized();
    const bool on_run =
        around_run.x() <= 0.0 || std::hypot(around_run.y(), point_mm.z()) >= spine.branch_mm;
    const bool on_branch =
        point_mm.x() > 0.0 && std::hypot(point_mm.x(), around_branch.x()) >= spine.run_mm;
    if (on_run && on_branch) {
        const ShapeFoot run = run_foot(shape, point_mm);
        const ShapeFoot branch = branch_foot(shape, point_mm);
        return std::abs(run.distance_mm) <= std::abs(branch.distance_mm) ? run : branch;
    }
    if (on_run) {
        return run_foot(shape, point_mm);
    }
    return on_branch ? branch_foot(shape, point_mm) : blend_foot(shape, point_mm);
}

}  // namespace meshwind
