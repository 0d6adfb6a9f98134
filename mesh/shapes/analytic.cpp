#include "mesh/shapes/analytic.h"

#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "core/units.h"
#include "mesh/nearest_parameter.h"
#include "mesh/shapes/profile.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Spine {
    double run_mm;     // radius of the run's offset cylinder
    double branch_mm;  // radius of the branch's offset cylinder, <= run_mm
    double lean_sin;
    double lean_cos;

    explicit Spine(const TeeShape& shape)
        : run_mm(shape.run_radius_mm + shape.blend_radius_mm),
          branch_mm(shape.branch_radius_mm + shape.blend_radius_mm),
          lean_sin(std::sin(shape.lean_rad)),
          lean_cos(std::cos(shape.lean_rad)) {}

    // x^2 = run^2 - branch^2 sin^2, written without cancellation for equal radii.
    [[nodiscard]] double x(double psi) const {
        const double c = branch_mm * std::cos(psi);
        return std::sqrt((run_mm - branch_mm) * (run_mm + branch_mm) + c * c);
    }
    [[nodiscard]] Vector3d point(double psi) const {
        const double x_mm = x(psi);
        return {x_mm, branch_mm * std::sin(psi), leaned(x_mm, branch_mm * std::cos(psi))};
    }
    // In the quarter 0 <= psi <= pi/2. Equal radii have a kink at pi/2; the limit from below holds
    // there.
    [[nodiscard]] Vector3d derivative(double psi) const {
        const double s = branch_mm * std::sin(psi);
        const double c = branch_mm * std::cos(psi);
        const double x_mm = x(psi);
        const double x_rate = x_mm > 0.0 ? -s * c / x_mm : -s;
        return {x_rate, c, leaned(x_rate, -s)};
    }

private:
    // z on the axis of a branch that leans, where x is given, and so far across it.
    [[nodiscard]] double leaned(double x_mm, double across_mm) const {
        return (x_mm * lean_sin + across_mm) / lean_cos;
    }
};

// Spine parameter nearest to a point with y >= 0, in [0, pi/2].
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
    const Vector3d seen = seen_from_branch(shape, point);
    const double radius = std::hypot(seen.y(), seen.z());
    const Vector3d normal = Vector3d(0.0, seen.y(), seen.z()) / radius;
    const Vector3d foot = shape.branch_radius_mm * normal + Vector3d(seen.x(), 0.0, 0.0);
    return {seen_from_run(shape, foot), seen_from_run(shape, normal),
            radius - shape.branch_radius_mm, ShapePart::Branch};
}

// The nearest place of the half spine on one side: +1 that to which the branch leans, -1 the other,
// which is its mirror image for a branch that leans as far to the other side.
Vector3d nearest_centre(const TeeShape& shape, double side, const Vector3d& point) {
    const Vector3d sign(1.0, std::copysign(1.0, point.y()), side);
    Spine spine(shape);
    spine.lean_sin *= side;
    return spine.point(nearest_psi(spine, point.cwiseProduct(sign))).cwiseProduct(sign);
}

ShapeFoot blend_foot(const TeeShape& shape, const Vector3d& point) {
    const double side = std::copysign(1.0, point.z());
    Vector3d centre = nearest_centre(shape, side, point);
    if (shape.lean_rad != 0.0) {
        const Vector3d other = nearest_centre(shape, -side, point);
        centre = (other - point).norm() < (centre - point).norm() ? other : centre;
    }
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

Vector3d seen_from_branch(const TeeShape& shape, const Vector3d& p) {
    const double c = std::cos(shape.lean_rad);
    const double s = std::sin(shape.lean_rad);
    return {p.x() * c + p.z() * s, p.y(), p.z() * c - p.x() * s};
}

Vector3d seen_from_run(const TeeShape& shape, const Vector3d& p) {
    const double c = std::cos(shape.lean_rad);
    const double s = std::sin(shape.lean_rad);
    return {p.x() * c - p.z() * s, p.y(), p.z() * c + p.x() * s};
}

Vector3d tee_spine_mm(const TeeShape& shape, double psi_rad) {
    return Spine(shape).point(psi_rad);
}

BlendArc blend_arc(const TeeShape& shape, double psi_rad) {
    const Vector3d centre = tee_spine_mm(shape, psi_rad);
    const Vector3d seen = seen_from_branch(shape, centre);
    return {centre, -Vector3d(centre.x(), centre.y(), 0.0).normalized(),
            -seen_from_run(shape, Vector3d(0.0, seen.y(), seen.z()).normalized())};
}

ShapeFoot tee_foot(const TeeShape& shape, const Vector3d& point_mm) {
    // The normals along a contact curve pass through the spine, so seen radially from its own axis
    // a point belongs to a cylinder exactly where that cylinder's offset lies outside the other's.
    const Spine spine(shape);
    const Vector2d around_run = spine.run_mm * point_mm.head<2>().normalized();
    const Vector3d off_branch =
        seen_from_branch(shape, {around_run.x(), around_run.y(), point_mm.z()});
    const bool on_run =
        around_run.x() <= 0.0 || std::hypot(off_branch.y(), off_branch.z()) >= spine.branch_mm;
    const Vector3d seen = seen_from_branch(shape, point_mm);
    const Vector2d around_branch = spine.branch_mm * seen.tail<2>().normalized();
    const Vector3d off_run = seen_from_run(shape, {seen.x(), around_branch.x(), around_branch.y()});
    const bool on_branch =
        seen.x() > 0.0 && off_run.x() > 0.0 && std::hypot(off_run.x(), off_run.y()) >= spine.run_mm;
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

ShapeFoot isotensoid_foot(const IsotensoidShape& shape, const Vector3d& point_mm) {
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
    const auto offer_bend = [&](double at_rad) {
        const Vector3d way(-std::cos(at_rad), 0.0, std::sin(at_rad));
        offer(bend_centre + shape.bend_radius_mm * way, ShapePart::Bend);
    };
    if (turn >= 0.0 && turn <= shape.angle_rad) {
        offer_bend(turn);
    }
    if (from_centre.z() <= 0.0) {
        offer({0.0, 0.0, point_mm.z()}, ShapePart::Leg);
    }
    if (along_leg2 >= 0.0) {
        offer(leg2_start + along_leg2 * leg2_way, ShapePart::Leg);
    }
    if (!best) {
        offer_bend(shape.angle_rad);  // by rounding between bend and second leg
    }
    return *best;
}

}  // namespace meshwind
