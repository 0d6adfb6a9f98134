#include "postproc/ringhead/frame_axis.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Points of Gauss for the length of a cubic: exact for polynomials of degree 9, so that the length
// of a step is good to rounding for any turn that a cubic can follow.
constexpr std::array<std::pair<double, double>, 5> kGauss = {
    {{0.0469100770306680, 0.1184634425280945},
     {0.2307653449471585, 0.2393143352496832},
     {0.5, 0.2844444444444444},
     {0.7692346550528415, 0.2393143352496832},
     {0.9530899229693319, 0.1184634425280945}}};

// Nearer to a station than this share of a step is at the station: no direction is left between.
constexpr double kAtStation = 1e-9;

struct CurvePoint {
    Vector3d point_mm;
    Vector3d speed_mm;  // per share
};

double angle_between(const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

CurvePoint cubic(const AxisStation& from, const AxisStation& to, double share) {
    const Vector3d chord = to.point_mm - from.point_mm;
    const double quarter = std::cos(0.25 * angle_between(from.tangent, to.tangent));
    const double speed = chord.norm() / (quarter * quarter);
    const Vector3d start = speed * from.tangent - chord;
    const Vector3d end = speed * to.tangent - chord;
    const double rest = 1.0 - share;
    return {from.point_mm + share * chord + share * rest * (rest * start - share * end),
            chord + rest * (rest - 2.0 * share) * start + share * (share - 2.0 * rest) * end};
}

double length_of(const AxisStation& from, const AxisStation& to) {
    double length_mm = 0.0;
    for (const auto& [share, weight] : kGauss) {
        length_mm += weight * cubic(from, to, share).speed_mm.norm();
    }
    return length_mm;
}

// v mirrored in the plane at a right angle to `normal`.
Vector3d mirrored(const Vector3d& v, const Vector3d& normal) {
    return v - (2.0 * v.dot(normal) / normal.squaredNorm()) * normal;
}

}  // namespace

Vector3d carried_reference(const Vector3d& from_mm, const Vector3d& from_tangent,
                           const Vector3d& to_mm, const Vector3d& to_tangent,
                           const Vector3d& reference) {
    const Vector3d step = to_mm - from_mm;
    const Vector3d tangent = mirrored(from_tangent, step);
    // Never zero: mirroring turns the tangent of a forward step backwards.
    const Vector3d carried = mirrored(mirrored(reference, step), to_tangent - tangent);
    return (carried - carried.dot(to_tangent) * to_tangent).normalized();
}

std::vector<Vector3d> parabola_tangents(std::span<const Vector3d> points_mm) {
    const std::size_t count = points_mm.size();
    assert(count >= 2);
    const auto slope = [&](std::size_t step) {
        return Vector3d((points_mm[step + 1] - points_mm[step]).normalized());
    };
    const auto step_mm = [&](std::size_t step) {
        return (points_mm[step + 1] - points_mm[step]).norm();
    };
    // The parabola over two neighbouring steps, at the point between them.
    const auto between = [&](std::size_t before, std::size_t after) {
        return Vector3d(step_mm(after) * slope(before) + step_mm(before) * slope(after))
            .normalized();
    };
    std::vector<Vector3d> tangents(count, slope(0));
    if (count == 2) {
        return tangents;
    }
    for (std::size_t i = 1; i + 1 < count; ++i) {
        tangents[i] = between(i - 1, i);
    }
    if ((points_mm.front() - points_mm.back()).norm() < kSamePoint_mm) {
        tangents.front() = tangents.back() = between(count - 2, 0);
        return tangents;
    }
    // At an end the parabola's slope is as far beyond the outer step as the inner point is before.
    const auto at_end = [&](std::size_t outer, std::size_t inner) {
        const double ratio = step_mm(outer) / (step_mm(outer) + step_mm(inner));
        return Vector3d(slope(outer) + ratio * (slope(outer) - slope(inner))).normalized();
    };
    tangents.front() = at_end(0, 1);
    tangents.back() = at_end(count - 2, count - 3);
    return tangents;
}

FrameAxis::FrameAxis(std::vector<AxisStation> stations) : stations_(std::move(stations)) {
    assert(stations_.size() >= 2);
    s_mm_.push_back(0.0);
    for (std::size_t i = 1; i < stations_.size(); ++i) {
        const AxisStation& from = stations_[i - 1];
        const AxisStation& to = stations_[i];
        s_mm_.push_back(s_mm_.back() + length_of(from, to));
        const Vector3d carried =
            carried_reference(from.point_mm, from.tangent, to.point_mm, to.tangent, from.reference);
        twist_rad_.push_back(
            std::atan2(to.tangent.dot(carried.cross(to.reference)), carried.dot(to.reference)));
    }
}

AxisFrame FrameAxis::at(double s_mm) const {
    const auto above = std::upper_bound(s_mm_.begin() + 1, s_mm_.end() - 1, s_mm);
    const std::size_t step = static_cast<std::size_t>(above - s_mm_.begin()) - 1;
    const double share =
        std::clamp((s_mm - s_mm_[step]) / (s_mm_[step + 1] - s_mm_[step]), 0.0, 1.0);
    const AxisStation& from = stations_[step];
    const AxisStation& to = stations_[step + 1];
    AxisFrame frame;
    double turn_rad = from.turn_rad;
    if (share < kAtStation) {
        frame = {from.point_mm, from.tangent, from.reference};
    } else if (share > 1.0 - kAtStation) {
        frame = {to.point_mm, to.tangent, to.reference};
        turn_rad = to.turn_rad;
    } else {
        const CurvePoint curve = cubic(from, to, share);
        frame.point_mm = curve.point_mm;
        frame.tangent = curve.speed_mm.normalized();
        frame.reference = carried_reference(from.point_mm, from.tangent, frame.point_mm,
                                            frame.tangent, from.reference);
        turn_rad += share * (to.turn_rad - from.turn_rad - twist_rad_[step]);
    }
    // The frame turns forward in the head when its reference turns backward on the frame.
    frame.reference = Eigen::AngleAxisd(-turn_rad, frame.tangent) * frame.reference;
    return frame;
}

}  // namespace meshwind
