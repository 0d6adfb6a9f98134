#include "mesh/shapes/profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "mesh/nearest_parameter.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector2d arc_point(const ProfilePiece& piece, double angle) {
    if (piece.isotensoid) {
        return {piece.isotensoid->radius_mm(angle),
                piece.centre_z_mm + piece.isotensoid->height_mm(angle)};
    }
    // cos(pi/2) is not quite zero; a pole must lie on the axis.
    const double radial = std::abs(angle) >= 0.5 * kPi ? 0.0 : std::cos(angle);
    return {piece.semi_axes_mm.x() * radial,
            piece.centre_z_mm + piece.semi_axes_mm.y() * std::sin(angle)};
}

Vector2d arc_derivative(const ProfilePiece& piece, double angle) {
    if (piece.isotensoid) {
        return piece.isotensoid->rate_mm(angle);
    }
    return {-piece.semi_axes_mm.x() * std::sin(angle), piece.semi_axes_mm.y() * std::cos(angle)};
}

// Arc length by Gauss's three points over `kParts` equal parts: 1e-9 of it up to axes of 1 : 5.
constexpr int kParts = 64;

double part_length(const ProfilePiece& piece, double low, double high) {
    constexpr double kNode = 0.7745966692414834;  // sqrt(3 / 5)
    const double half = 0.5 * (high - low);
    const double middle = 0.5 * (high + low);
    const auto speed = [&](double x) { return arc_derivative(piece, middle + half * x).norm(); };
    return half * (5.0 * speed(-kNode) + 8.0 * speed(0.0) + 5.0 * speed(kNode)) / 9.0;
}

std::array<double, kParts + 1> length_table(const ProfilePiece& piece) {
    std::array<double, kParts + 1> length{};
    const double step = (piece.to_rad - piece.from_rad) / kParts;
    for (std::size_t i = 0; i < kParts; ++i) {
        const double low = piece.from_rad + step * static_cast<double>(i);
        length[i + 1] = length[i] + part_length(piece, low, low + step);
    }
    return length;
}

ProfilePiece line(ShapePart part, const Vector2d& from, const Vector2d& to) {
    ProfilePiece piece;
    piece.part = part;
    piece.from_mm = from;
    piece.to_mm = to;
    piece.semi_axes_mm = Vector2d::Zero();
    return piece;
}

ProfilePiece dome(double centre_z, const Vector2d& semi_axes, double from, double to) {
    ProfilePiece piece;
    piece.part = ShapePart::Dome;
    piece.from_mm = piece.to_mm = Vector2d::Zero();
    piece.centre_z_mm = centre_z;
    piece.semi_axes_mm = semi_axes;
    piece.from_rad = from;
    piece.to_rad = to;
    return piece;
}

double opening_angle(double radius, double opening) {
    return opening > 0.0 ? std::acos(opening / radius) : 0.5 * kPi;
}

struct PlaneFoot {
    Vector2d point;
    Vector2d normal;
};

// `free_low` and `free_high`: the piece is the profile's first or last and goes on.
PlaneFoot line_foot(const ProfilePiece& piece, const Vector2d& p, bool free_low, bool free_high) {
    const Vector2d way = piece.to_mm - piece.from_mm;
    double share = (p - piece.from_mm).dot(way) / way.squaredNorm();
    share = free_low ? share : std::max(share, 0.0);
    share = free_high ? share : std::min(share, 1.0);
    return {piece.from_mm + share * way, Vector2d(way.y(), -way.x()).normalized()};
}

PlaneFoot arc_foot(const ProfilePiece& piece, const Vector2d& p, bool free_low, bool free_high) {
    const double low = free_low ? -0.5 * kPi : piece.from_rad;
    const double high = free_high ? 0.5 * kPi : piece.to_rad;
    // The quarter the point is in holds the nearest point of the arc.
    const bool upper = p.y() >= piece.centre_z_mm;
    const ParameterRange range{upper ? std::max(low, 0.0) : low,
                               upper ? high : std::min(high, 0.0)};
    if (range.low >= range.high) {
        const double angle = upper ? high : low;
        const Vector2d way = arc_derivative(piece, angle);
        return {arc_point(piece, angle), Vector2d(way.y(), -way.x()).normalized()};
    }
    const double angle = nearest_parameter(
        range, [&](double t) { return (arc_point(piece, t) - p).squaredNorm(); },
        [&](double t) { return (arc_point(piece, t) - p).dot(arc_derivative(piece, t)); });
    const Vector2d way = arc_derivative(piece, angle);
    return {arc_point(piece, angle), Vector2d(way.y(), -way.x()).normalized()};
}

}  // namespace

Vector2d ProfilePiece::point_mm(double share) const {
    if (is_line()) {
        return from_mm + share * (to_mm - from_mm);
    }
    const auto length = length_table(*this);
    const double wanted = share * length.back();
    const auto above = std::upper_bound(length.begin() + 1, length.end() - 1, wanted);
    const double inside = std::clamp((wanted - *(above - 1)) / (*above - *(above - 1)), 0.0, 1.0);
    const double steps = static_cast<double>(above - 1 - length.begin()) + inside;
    return arc_point(*this,
                     share >= 1.0 ? to_rad : from_rad + (to_rad - from_rad) * steps / kParts);
}

double ProfilePiece::length_mm() const {
    return is_line() ? (to_mm - from_mm).norm() : length_table(*this).back();
}

Profile profile_of(const CylinderShape& shape) {
    const double half = 0.5 * shape.length_mm;
    return {line(ShapePart::Cylinder, {shape.radius_mm, -half}, {shape.radius_mm, half})};
}

Profile profile_of(const ConeShape& shape) {
    const double half = 0.5 * shape.length_mm;
    return {line(ShapePart::Cone, {shape.radius1_mm, -half}, {shape.radius2_mm, half})};
}

Profile profile_of(const VesselShape& shape) {
    const double half = 0.5 * shape.cylinder_length_mm;
    const double below = opening_angle(shape.radius_mm, shape.opening_radius_mm);
    const double above = opening_angle(shape.radius_mm, shape.upper_opening_mm());
    const Vector2d axes(shape.radius_mm, shape.dome_height_mm);
    return {dome(-half, axes, -below, 0.0),
            line(ShapePart::Cylinder, {shape.radius_mm, -half}, {shape.radius_mm, half}),
            dome(half, axes, 0.0, above)};
}

Profile profile_of(const IsotensoidShape& shape) {
    const double half = 0.5 * shape.cylinder_length_mm;
    const IsotensoidDome curve(shape.dome());
    const double open = curve.parameter_at(shape.opening_radius_mm);
    ProfilePiece upper = dome(half, Vector2d(shape.radius_mm, curve.height_mm(open)), 0.0, open);
    upper.isotensoid = curve;
    ProfilePiece lower = upper;
    lower.centre_z_mm = -half;
    lower.from_rad = -open;
    lower.to_rad = 0.0;
    return {std::move(lower),
            line(ShapePart::Cylinder, {shape.radius_mm, -half}, {shape.radius_mm, half}),
            std::move(upper)};
}

Profile profile_of(const CombinationShape& shape) {
    const double z1 = shape.length1_mm;
    const double z2 = z1 + shape.cone_length_mm;
    const double z3 = z2 + shape.length2_mm;
    Profile profile{line(ShapePart::Cylinder, {shape.radius1_mm, 0.0}, {shape.radius1_mm, z1}),
                    line(ShapePart::Cone, {shape.radius1_mm, z1}, {shape.radius2_mm, z2}),
                    line(ShapePart::Cylinder, {shape.radius2_mm, z2}, {shape.radius2_mm, z3}),
                    dome(z3, {shape.radius2_mm, shape.dome_height_mm}, 0.0,
                         opening_angle(shape.radius2_mm, shape.opening_radius_mm))};
    profile[0].sharp_end = profile[1].sharp_end = shape.radius1_mm != shape.radius2_mm;
    return profile;
}

Profile profile_of(const EllipsoidShape& shape) {
    const Vector2d axes(shape.equator_radius_mm, shape.pole_radius_mm);
    return {dome(0.0, axes, -0.5 * kPi, 0.0), dome(0.0, axes, 0.0, 0.5 * kPi)};
}

ShapeFoot profile_foot(const Profile& profile, const Vector3d& point_mm) {
    const Vector2d p(point_mm.head<2>().norm(), point_mm.z());
    const Vector2d radial = p.x() > 0.0 ? Vector2d(point_mm.head<2>() / p.x()) : Vector2d::UnitX();
    ShapeFoot best;
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const bool first = i == 0;
        const bool last = i + 1 == profile.size();
        const PlaneFoot foot = profile[i].is_line() ? line_foot(profile[i], p, first, last)
                                                    : arc_foot(profile[i], p, first, last);
        const double distance =
            std::copysign((p - foot.point).norm(), (p - foot.point).dot(foot.normal));
        if (i == 0 || std::abs(distance) < std::abs(best.distance_mm)) {
            best.point_mm << foot.point.x() * radial, foot.point.y();
            best.normal << foot.normal.x() * radial, foot.normal.y();
            best.distance_mm = distance;
            best.part = profile[i].part;
        }
    }
    return best;
}

}  // namespace meshwind
