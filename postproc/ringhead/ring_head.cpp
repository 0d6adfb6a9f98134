#include "postproc/ringhead/ring_head.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/roots.h"
#include "core/small_linear.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Steps between two samples of the axis on the way to a ring: halved this often, a place is found
// to 1e-12 of a step.
constexpr int kHalvings = 40;

Matrix3d triad(const Vector3d& first, const Vector3d& second) {
    Matrix3d axes;
    axes << first, second, first.cross(second);
    return axes;
}

double angle_between(const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

double nearest_turn(double angle_rad, double to_rad) {
    return angle_rad + 2.0 * kPi * std::round((to_rad - angle_rad) / (2.0 * kPi));
}

EulerZyx nearest(EulerZyx angles, const EulerZyx& to) {
    return {nearest_turn(angles.a_rad, to.a_rad), nearest_turn(angles.b_rad, to.b_rad),
            nearest_turn(angles.c_rad, to.c_rad)};
}

double largest_step(const EulerZyx& from, const EulerZyx& to) {
    return std::max({std::abs(to.a_rad - from.a_rad), std::abs(to.b_rad - from.b_rad),
                     std::abs(to.c_rad - from.c_rad)});
}

CarryError worse(const CarryError& a, const CarryError& b) {
    return {std::max(a.distance_mm, b.distance_mm), std::max(a.tilt_rad, b.tilt_rad),
            std::max(a.turn_rad, b.turn_rad)};
}

double share_of(const CarryError& error, const CarryTolerance& tolerance) {
    return std::max(error.distance_mm / tolerance.distance_mm,
                    error.turn_rad / tolerance.angle_rad);
}

// Places from `from_s_mm` to `to_s_mm`, both included: kErrorSamples in each piece between
// stations.
std::vector<double> samples_between(const FrameAxis& axis, double from_s_mm, double to_s_mm) {
    std::vector<double> ends = {from_s_mm};
    const std::vector<double>& stations = axis.station_s_mm();
    const auto first = std::upper_bound(stations.begin(), stations.end(), from_s_mm);
    ends.insert(ends.end(), first, std::lower_bound(first, stations.end(), to_s_mm));
    ends.push_back(to_s_mm);
    std::vector<double> samples = {from_s_mm};
    for (std::size_t i = 1; i < ends.size(); ++i) {
        for (int k = 1; k <= kErrorSamples; ++k) {
            samples.push_back(ends[i - 1] + (ends[i] - ends[i - 1]) * k / kErrorSamples);
        }
    }
    return samples;
}

class PointChooser {
public:
    PointChooser(const RingHead& head, const FrameAxis& axis, const CarryTolerance& tolerance)
        : head_(head), axis_(axis), tolerance_(tolerance) {}

    CarryPoints run() && {
        points_.s_mm.push_back(0.0);
        append(0.0, axis_.length_mm());
        return std::move(points_);
    }

private:
    [[nodiscard]] Isometry3d pose(double s_mm) const { return carried_pose(head_, axis_.at(s_mm)); }

    // The station nearest to the middle of a move, the middle where there is none.
    [[nodiscard]] double middle(double from_s_mm, double to_s_mm) const {
        const double half = 0.5 * (from_s_mm + to_s_mm);
        const std::vector<double>& stations = axis_.station_s_mm();
        const auto after = std::lower_bound(stations.begin(), stations.end(), half);
        double best = half;
        double gap = to_s_mm - from_s_mm;
        for (const auto s : {after, after == stations.begin() ? after : after - 1}) {
            const bool inside = s != stations.end() && *s - from_s_mm > kShortestMove_mm &&
                                to_s_mm - *s > kShortestMove_mm;
            if (inside && std::abs(*s - half) < gap) {
                gap = std::abs(*s - half);
                best = *s;
            }
        }
        return best;
    }

    void append(double from_s_mm, double to_s_mm) {
        const CarryError error =
            lin_error(head_, axis_, from_s_mm, to_s_mm, pose(from_s_mm), pose(to_s_mm));
        const double share = share_of(error, tolerance_);
        // The last move of a table may be shorter; two halves of it would be too.
        const double length_mm = to_s_mm - from_s_mm;
        if ((share > kKeptShare || length_mm > tolerance_.longest_mm) &&
            length_mm > 2.0 * kShortestMove_mm) {
            const double half = middle(from_s_mm, to_s_mm);
            append(from_s_mm, half);
            append(half, to_s_mm);
            return;
        }
        points_.s_mm.push_back(to_s_mm);
        points_.worst = worse(points_.worst, error);
        points_.ok = points_.ok && share <= 1.0;
        if (share > worst_share_) {
            worst_share_ = share;
            points_.worst_s_mm = from_s_mm;
        }
    }

    const RingHead& head_;
    const FrameAxis& axis_;
    const CarryTolerance& tolerance_;
    CarryPoints points_;
    double worst_share_ = 0.0;
};

// Follows the axis from `samples[centre]` in steps of `step` to the plane of a ring.
std::optional<AxisFrame> at_ring(const FrameAxis& axis, const std::vector<double>& samples,
                                 std::size_t centre, int step, double way_mm, bool& through) {
    const AxisFrame middle = axis.at(samples[centre]);
    const auto ahead = [&](double s_mm) {
        return step * middle.tangent.dot(axis.at(s_mm).point_mm - middle.point_mm);
    };
    double inside = samples[centre];
    double highest = 0.0;
    for (std::size_t i = centre; step > 0 ? i + 1 < samples.size() : i > 0;) {
        i = step > 0 ? i + 1 : i - 1;
        const double reached = ahead(samples[i]);
        if (reached < highest - kSamePoint_mm) {
            through = false;  // turned back: it leaves the head sideways
            return std::nullopt;
        }
        highest = std::max(highest, reached);
        if (reached < way_mm) {
            inside = samples[i];
            continue;
        }
        const auto is_inside = [&](double s_mm) { return ahead(s_mm) < way_mm; };
        return axis.at(halve({.holds = inside, .fails = samples[i]}, kHalvings, is_inside).fails);
    }
    return std::nullopt;
}

}  // namespace

Isometry3d carried_pose(const RingHead& head, const AxisFrame& axis) {
    Isometry3d pose = Isometry3d::Identity();
    pose.linear() =
        triad(head.direction, head.reference) * triad(axis.tangent, axis.reference).transpose();
    pose.translation() = head.centre_mm - pose.linear() * axis.point_mm;
    return pose;
}

Matrix3d EulerZyx::matrix() const {
    return (Eigen::AngleAxisd(a_rad, Vector3d::UnitZ()) *
            Eigen::AngleAxisd(b_rad, Vector3d::UnitY()) *
            Eigen::AngleAxisd(c_rad, Vector3d::UnitX()))
        .toRotationMatrix();
}

EulerZyx euler_zyx(const Matrix3d& q, const std::optional<EulerZyx>& previous) {
    const bool singular = std::hypot(q(0, 0), q(1, 0)) < kSingularCosine;
    const double kept = previous ? previous->a_rad : 0.0;
    EulerZyx first;
    first.a_rad = singular ? kept : std::atan2(q(1, 0), q(0, 0));
    const double ca = std::cos(first.a_rad);
    const double sa = std::sin(first.a_rad);
    first.b_rad = std::atan2(-q(2, 0), q(0, 0) * ca + q(1, 0) * sa);
    first.c_rad = std::atan2(q(0, 2) * sa - q(1, 2) * ca, q(1, 1) * ca - q(0, 1) * sa);
    if (!previous) {
        return first;
    }
    const EulerZyx near = nearest(first, *previous);
    if (singular) {
        return near;
    }
    const EulerZyx other =
        nearest({first.a_rad + kPi, kPi - first.b_rad, first.c_rad + kPi}, *previous);
    return largest_step(*previous, other) < largest_step(*previous, near) ? other : near;
}

SwivelSpin swivel_and_spin(const Isometry3d& from, const Isometry3d& to) {
    const Vector3d start = from.linear().col(0);
    const Vector3d end = to.linear().col(0);
    const Matrix3d swivelled = shortest_turn(start, end).toRotationMatrix() * from.linear();
    const Matrix3d spin = swivelled.transpose() * to.linear();
    return {angle_between(start, end), std::atan2(spin(2, 1), spin(1, 1))};
}

Isometry3d lin_between(const Isometry3d& from, const Isometry3d& to, double share, TurnLaw law) {
    Isometry3d pose = Isometry3d::Identity();
    pose.translation() = from.translation() + share * (to.translation() - from.translation());
    if (law == TurnLaw::OneAxis) {
        pose.linear() = Eigen::Quaterniond(from.linear())
                            .slerp(share, Eigen::Quaterniond(to.linear()))
                            .toRotationMatrix();
        return pose;
    }
    const Eigen::Quaterniond swivel = shortest_turn(from.linear().col(0), to.linear().col(0));
    const double spin_rad = swivel_and_spin(from, to).spin_rad;
    pose.linear() = Eigen::Quaterniond::Identity().slerp(share, swivel).toRotationMatrix() *
                    from.linear() *
                    Eigen::AngleAxisd(share * spin_rad, Vector3d::UnitX()).toRotationMatrix();
    return pose;
}

double turn_between(const Isometry3d& from, const Isometry3d& to) {
    return Eigen::Quaterniond(from.linear()).angularDistance(Eigen::Quaterniond(to.linear()));
}

CarryError carry_error(const RingHead& head, const Isometry3d& pose, const AxisFrame& axis) {
    return {(pose * axis.point_mm - head.centre_mm).norm(),
            angle_between(pose.linear() * axis.tangent, head.direction),
            turn_between(carried_pose(head, axis), pose)};
}

CarryError lin_error(const RingHead& head, const FrameAxis& axis, double from_s_mm, double to_s_mm,
                     const Isometry3d& from, const Isometry3d& to) {
    assert(from_s_mm < to_s_mm);
    CarryError worst;
    for (const double s : samples_between(axis, from_s_mm, to_s_mm)) {
        const double share = (s - from_s_mm) / (to_s_mm - from_s_mm);
        const AxisFrame wanted = axis.at(s);
        for (const TurnLaw law : {TurnLaw::OneAxis, TurnLaw::SwivelAndSpin}) {
            worst = worse(worst, carry_error(head, lin_between(from, to, share, law), wanted));
        }
    }
    return worst;
}

CarryPoints choose_carry_points(const RingHead& head, const FrameAxis& axis,
                                const CarryTolerance& tolerance) {
    return PointChooser(head, axis, tolerance).run();
}

RingFit worst_ring_fit(const RingHead& head, const FrameAxis& axis, double tube_radius_mm) {
    const std::vector<double> samples = samples_between(axis, 0.0, axis.length_mm());
    RingFit worst;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const AxisFrame middle = axis.at(samples[i]);
        for (const int step : {-1, 1}) {
            bool through = true;
            const auto ring = at_ring(axis, samples, i, step, 0.5 * head.ring_distance_mm, through);
            if (!through && worst.through) {
                worst.through = false;
                worst.s_mm = samples[i];
            }
            if (!ring || !worst.through) {
                continue;
            }
            const double offset = middle.tangent.cross(ring->point_mm - middle.point_mm).norm();
            const double tilt = angle_between(middle.tangent, ring->tangent);
            const double reach = offset + tube_radius_mm / std::cos(tilt);
            if (reach > worst.reach_mm) {
                worst = {reach, offset, tilt, samples[i], true};
            }
        }
    }
    return worst;
}

double ring_turns_per_mm(double angle_rad, double tube_radius_mm) {
    assert(angle_rad >= 0.0 && angle_rad < 0.5 * kPi && tube_radius_mm > 0.0);
    return std::tan(angle_rad) / (2.0 * kPi * tube_radius_mm);
}

double laid_angle_rad(double tube_radius_mm, double ring_rad_s, double frame_rad_s,
                      double passage_mm_s) {
    return std::atan(tube_radius_mm * (ring_rad_s - frame_rad_s) / passage_mm_s);
}

double ring_coverage(int tows, double tow_width_mm, double angle_rad, double tube_radius_mm) {
    return tows * tow_width_mm / (2.0 * kPi * tube_radius_mm * std::cos(angle_rad));
}

double frame_turn_rad(const RingHead& head, const Isometry3d& from, const Isometry3d& to) {
    const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
    return turn.angle() * turn.axis().dot(head.direction);
}

}  // namespace meshwind
