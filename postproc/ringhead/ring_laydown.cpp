#include "postproc/ringhead/ring_laydown.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// A fibre whose spool is this near to the tangent plane touches there: rounding of coordinates of
// a metre is 1e-13 m, and a hundred thousand times that is nothing to a fibre.
constexpr double kTouch_mm = 1e-8;
constexpr int kRollSteps = 40;
// One step lays a few tenths of a mm; a solution further on is another sheet of the tube.
constexpr double kLongestRoll_mm = 5.0;
// The straight fibre is searched for contact at so many places, every few steps; between them the
// tube of 20 mm rises by less than 0.1 mm over it.
constexpr int kFreeSamples = 24;
constexpr std::size_t kFreeEvery = 8;
// Within the sag of the free fibre's sampling: no contact yet.
constexpr double kFreeDepth_mm = 0.02;

Isometry3d head_in_base(const RingHead& head) {
    Isometry3d pose = Isometry3d::Identity();
    pose.linear().col(0) = head.reference;
    pose.linear().col(1) = head.direction.cross(head.reference);
    pose.linear().col(2) = head.direction;
    pose.translation() = head.centre_mm;
    return pose;
}

std::array<double, 2> rings_at(const std::vector<RingKnot>& knots, double time_s) {
    const auto above =
        std::upper_bound(knots.begin(), knots.end(), time_s,
                         [](double time, const RingKnot& knot) { return time < knot.time_s; });
    if (above == knots.begin()) {
        return knots.front().ring_rad;
    }
    if (above == knots.end()) {
        return knots.back().ring_rad;
    }
    const RingKnot& low = *(above - 1);
    const double share = (time_s - low.time_s) / (above->time_s - low.time_s);
    return {low.ring_rad[0] + share * (above->ring_rad[0] - low.ring_rad[0]),
            low.ring_rad[1] + share * (above->ring_rad[1] - low.ring_rad[1])};
}

// Follows one fibre.
class Layer {
public:
    Layer(const TubeSurface& tube, RingFibre& fibre) : tube_(tube), fibre_(fibre) {}

    void tie(const Vector3d& point_mm, double near_s_mm, const Vector3d& spool, double time_s) {
        at_ = tube_.foot(point_mm, near_s_mm);
        direction_ = towards(at_, spool);
        append(spool, time_s);
    }

    void follow(const Vector3d& spool, double time_s, bool look_ahead) {
        peel(spool);
        if (height(at_, spool) < -kTouch_mm && roll(spool)) {
            append(spool, time_s);
        } else {
            direction_ = towards(at_, spool);
        }
        if (look_ahead && jump(spool)) {
            append(spool, time_s);
        }
    }

private:
    static double height(const TubeFoot& at, const Vector3d& spool) {
        return at.normal.dot(spool - at.surface_mm);
    }

    // Unit, in the tangent plane.
    static Vector3d towards(const TubeFoot& at, const Vector3d& spool) {
        const Vector3d way = spool - at.surface_mm;
        return (way - way.dot(at.normal) * at.normal).normalized();
    }

    [[nodiscard]] double curvature() const { return tube_.normal_curvature(at_, direction_); }

    void peel(const Vector3d& spool) {
        std::vector<LaidRingPoint>& points = fibre_.points;
        while (points.size() > 1 && height(at_, spool) > kTouch_mm) {
            const double piece =
                (points.back().point_mm - points[points.size() - 2].point_mm).norm();
            fibre_.peeled_mm += piece;
            fibre_.length_mm -= piece;
            points.pop_back();
            at_ = tube_.foot(points.back().point_mm, points.back().s_mm);
            direction_ = towards(at_, spool);
        }
    }

    // Moves the landing point on until the spool is in the tangent plane; false where the tube is
    // hollow along the fibre.
    bool roll(const Vector3d& spool) {
        const double free_mm = (spool - at_.surface_mm).norm();
        double before_mm = 0.0;
        double before = height(at_, spool);
        const double bend = curvature();
        if (bend <= 0.0) {
            return jump(spool);
        }
        double way_mm = -before / (free_mm * bend);
        Vector3d chord = (direction_ + towards(at_, spool)).normalized();
        for (int k = 0; k < kRollSteps && std::abs(way_mm) < kLongestRoll_mm; ++k) {
            const TubeFoot next = tube_.foot(at_.surface_mm + way_mm * chord, at_.s_mm);
            const double now = height(next, spool);
            const Vector3d ahead = towards(next, spool);
            if (std::abs(now) < 0.1 * kTouch_mm) {
                at_ = next;
                direction_ = ahead;
                return true;
            }
            const double slope = (now - before) / (way_mm - before_mm);
            before_mm = way_mm;
            before = now;
            way_mm -= slope > 0.0 ? now / slope : 0.5 * way_mm;
            chord = (direction_ + ahead).normalized();
        }
        return jump(spool);
    }

    // Where the straight fibre is under the tube's surface, the landing point goes to the deepest
    // place and leaves a bridge.
    bool jump(const Vector3d& spool) {
        const Vector3d from = at_.surface_mm;
        double deepest = -kFreeDepth_mm;
        TubeFoot contact;
        double near_s_mm = at_.s_mm;
        for (int k = 1; k < kFreeSamples; ++k) {
            const double share = static_cast<double>(k) / kFreeSamples;
            const TubeFoot foot = tube_.foot(from + share * (spool - from), near_s_mm);
            near_s_mm = foot.s_mm;
            if (foot.distance_mm - tube_.radius_mm() < deepest) {
                deepest = foot.distance_mm - tube_.radius_mm();
                contact = foot;
            }
        }
        if (deepest >= -kFreeDepth_mm) {
            return false;
        }
        const double length_mm = (contact.surface_mm - from).norm();
        double gap_mm = -deepest;
        for (int k = 1; k < kFreeSamples; ++k) {
            const double share = static_cast<double>(k) / kFreeSamples;
            const TubeFoot foot = tube_.foot(from + share * (contact.surface_mm - from), at_.s_mm);
            gap_mm = std::max(gap_mm, foot.distance_mm - tube_.radius_mm());
        }
        fibre_.bridges.push_back({at_.s_mm, length_mm, gap_mm});
        at_ = contact;
        direction_ = towards(at_, spool);
        return true;
    }

    void append(const Vector3d& spool, double time_s) {
        LaidRingPoint point;
        point.point_mm = at_.surface_mm;
        point.normal = at_.normal;
        point.s_mm = at_.s_mm;
        point.stretch = tube_.stretch(at_);
        point.time_s = time_s;
        // Of the line: carried back, fibre runs towards the axis' start.
        const double along = direction_.dot(at_.tangent);
        const double round = direction_.dot(at_.tangent.cross(at_.normal));
        point.angle_rad = std::atan2(along < 0.0 ? -round : round, std::abs(along));
        point.kn_per_mm = curvature();
        point.free_mm = (spool - at_.surface_mm).norm();
        point.round_rad = at_.round_rad;
        if (!fibre_.points.empty()) {
            const LaidRingPoint& last = fibre_.points.back();
            point.round_rad +=
                2.0 * kPi * std::round((last.round_rad - at_.round_rad) / (2.0 * kPi));
            fibre_.length_mm += (point.point_mm - last.point_mm).norm();
        }
        fibre_.points.push_back(point);
    }

    const TubeSurface& tube_;
    RingFibre& fibre_;
    TubeFoot at_;
    Vector3d direction_ = Vector3d::UnitZ();
};

}  // namespace

std::vector<HeadState> play_head(const KrlProgram& program, const std::vector<RingKnot>& knots,
                                 const RingHead& head, const TubeSurface& tube, TurnLaw law) {
    assert(!knots.empty() && program.moves.size() >= 2);
    const Isometry3d head_pose = head_in_base(head);
    const std::vector<double> duration_s = durations_s(program);
    std::vector<HeadState> states;
    const auto add = [&](const Isometry3d& pose, double time_s) {
        HeadState state;
        state.time_s = time_s;
        state.head_in_mandrel = pose.inverse() * head_pose;
        state.ring_rad = rings_at(knots, time_s);
        state.s_mm = tube.foot(state.head_in_mandrel.translation(),
                               states.empty() ? 0.0 : states.back().s_mm)
                         .s_mm;
        states.push_back(state);
    };
    add(pose_of(program.moves.front().to), 0.0);
    double start_s = 0.0;
    std::size_t knot = 0;
    for (std::size_t i = 1; i < program.moves.size(); ++i) {
        const Isometry3d from = pose_of(program.moves[i - 1].to);
        const Isometry3d to = pose_of(program.moves[i].to);
        const double end_s = start_s + duration_s[i];
        // Of the frame's origin; in the head it passes by less than that and its turn together.
        const double passage_mm =
            (from.inverse() * head.centre_mm - to.inverse() * head.centre_mm).norm();
        const double frame_rad = turn_between(from, to);
        while (knot < knots.size() && knots[knot].time_s <= start_s) {
            ++knot;
        }
        double low_s = start_s;
        while (low_s < end_s) {
            const double high_s = knot < knots.size() ? std::min(end_s, knots[knot].time_s) : end_s;
            const auto before = rings_at(knots, low_s);
            const auto after = rings_at(knots, high_s);
            const double part = (high_s - low_s) / duration_s[i];
            double turn_rad = 0.0;
            for (std::size_t ring = 0; ring < before.size(); ++ring) {
                turn_rad = std::max(turn_rad, std::abs(after[ring] - before[ring]));
            }
            turn_rad += part * frame_rad;
            const int pieces =
                std::max(1, static_cast<int>(std::ceil(std::max(
                                turn_rad / kRingStep_rad, part * passage_mm / kPassStep_mm))));
            for (int k = 1; k <= pieces; ++k) {
                const double time_s = low_s + (high_s - low_s) * k / pieces;
                add(lin_between(from, to, (time_s - start_s) / duration_s[i], law), time_s);
            }
            low_s = high_s;
            if (knot < knots.size() && knots[knot].time_s <= low_s) {
                ++knot;
            }
        }
        start_s = end_s;
    }
    return states;
}

std::vector<RingFibre> lay_ring_fibres(const std::vector<HeadState>& states, const RingHead& head,
                                       const TubeSurface& tube, const RingSpools& spools) {
    assert(spools.count >= 1 && spools.radius_mm > tube.radius_mm() && !states.empty());
    const auto ring = static_cast<std::size_t>(spools.ring);
    const double plane_mm = (ring == 0 ? 0.5 : -0.5) * head.ring_distance_mm;
    const double touch_rad =
        (spools.right_handed ? 1.0 : -1.0) * std::acos(tube.radius_mm() / spools.radius_mm);
    std::vector<RingFibre> fibres;
    for (int spool = 0; spool < spools.count; ++spool) {
        const double place_rad = spools.phase_rad + 2.0 * kPi * spool / spools.count;
        const auto spool_at = [&](const HeadState& state) {
            const double turn = state.ring_rad[ring] + place_rad;
            return Vector3d(state.head_in_mandrel * Vector3d(spools.radius_mm * std::cos(turn),
                                                             spools.radius_mm * std::sin(turn),
                                                             plane_mm));
        };
        RingFibre fibre;
        fibre.ring = spools.ring;
        fibre.spool = spool;
        Layer layer(tube, fibre);
        const HeadState& start = states.front();
        const Vector3d first = spool_at(start);
        const double round_rad = tube.foot(first, start.s_mm + plane_mm).round_rad - touch_rad;
        layer.tie(tube.point(spools.tie_s_mm, round_rad), spools.tie_s_mm, first, start.time_s);
        for (std::size_t i = 1; i < states.size(); ++i) {
            layer.follow(spool_at(states[i]), states[i].time_s, i % kFreeEvery == 0);
        }
        fibres.push_back(std::move(fibre));
    }
    return fibres;
}

double landing_lag_mm(double spool_radius_mm, double tube_radius_mm, double angle_rad) {
    assert(angle_rad > 0.0 && spool_radius_mm > tube_radius_mm);
    return std::sqrt(spool_radius_mm * spool_radius_mm - tube_radius_mm * tube_radius_mm) /
           std::tan(angle_rad);
}

}  // namespace meshwind
