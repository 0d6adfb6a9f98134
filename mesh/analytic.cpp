#include "mesh/analytic.h"

#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "core/units.h"
#include "mesh/nearest_parameter.h"
#include "mesh/profile.h"

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
    return nearest_parameter(
        {0.0, 0.5 * kPi}, [&](double psi) { return (spine.point(psi) - point).squaredNorm(); },
        [&](double psi) { return (spine.point(psi) - point).dot(spine.derivative(psi)); });
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

// A pipe seen from the nearest point of its centre line.
struct PipeCentre {
    Vector3d centre;
    double radius_mm;
    ShapePart part;
};

ShapeFoot pipe_foot(const PipeCentre& pipe, const Vector3d& point) {
    const double distance = (point - pipe.centre).norm();
    const Vector3d normal = (point - pipe.centre) / distance;
    return {pipe.centre + pipe.radius_mm * normal, normal, distance - pipe.radius_mm, pipe.part};
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

ShapeFoot cylinder_foot(const CylinderShape& shape, const Vector3d& point_mm) {
    return profile_foot(profile_of(shape), point_mm);
}

ShapeFoot cone_foot(const ConeShape& shape, const Vector3d& point_mm) {
    return profile_foot(profile_of(shape), point_mm);
}

ShapeFoot vessel_foot(const VesselShape& shape, const Vector3d& point_mm) {
    return profile_foot(profile_of(shape), point_mm);
}

ShapeFoot combination_foot(const CombinationShape& shape, const Vector3d& point_mm) {
    return profile_foot(profile_of(shape), point_mm);
}

ShapeFoot ellipsoid_foot(const EllipsoidShape& shape, const Vector3d& point_mm) {
    return profile_foot(profile_of(shape), point_mm);
}

ShapeFoot torus_foot(const TorusShape& shape, const Vector3d& point_mm) {
    const Vector3d axis_point(point_mm.x(), point_mm.y(), 0.0);
    const Vector3d centre = shape.ring_radius_mm * axis_point.normalized();
    return pipe_foot({centre, shape.tube_radius_mm, ShapePart::Bend}, point_mm);
}

ShapeFoot elbow_foot(const ElbowShape& shape, const Vector3d& point_mm) {
    const double pipe = shape.pipe_radius_mm;
    const double c = std::cos(shape.angle_rad);
    const double s = std::sin(shape.angle_rad);
    const Vector3d bend_centre(shape.bend_radius_mm, 0.0, shape.leg1_mm);
    const Vector3d from_centre = point_mm - bend_centre;
    const Vector3d leg2_start = bend_centre + shape.bend_radius_mm * Vector3d(-c, 0.0, s);
    const Vector3d leg2_way(s, 0.0, c);
    const double turn = std::atan2(from_centre.z(), -from_centre.x());
    const double along_leg2 = (point_mm - leg2_start).dot(leg2_way);
    std::optional<ShapeFoot> best;
    const auto offer = [&](const Vector3d& centre, ShapePart part) {
        const ShapeFoot foot = pipe_foot({centre, pipe, part}, point_mm);
        if (!best || std::abs(foot.distance_mm) < std::abs(best->distance_mm)) {
            best = foot;
        }
    };
    if (turn >= 0.0 && turn <= shape.angle_rad) {
        const Vector3d way(-std::cos(turn), 0.0, std::sin(turn));
        offer(bend_centre + shape.bend_radius_mm * way, ShapePart::Bend);
    }
    if (from_centre.z() <= 0.0 || !best) {
        offer({0.0, 0.0, point_mm.z()}, ShapePart::Leg);
    }
    if (along_leg2 >= 0.0) {
        offer(leg2_start + along_leg2 * leg2_way, ShapePart::Leg);
    }
    return *best;
}

}  // namespace meshwind
