#include "winding/pattern_begin.h"

#include <cmath>
#include <utility>

#include "core/text_number.h"
#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Kind = ConnectingGoal::Kind;

// Share of the friction that connecting passes are steered with: over the steps that other layers
// leave, the press of the fibre changes within a few mm, and the laid fibre evens that out.
constexpr double kConnecting = 0.7;

// A fibre along a parallel: the sine of its angle to the meridian.
constexpr double kAlong = 1.0 - 1e-5;

class Beginner {
public:
    Beginner(const Meridian& meridian, const RevolutionPieces& pieces,
             const std::array<ConnectingGoal, 2>& goal, const std::array<MeridianStation, 2>& first,
             const TurnRule& rule)
        : meridian_(meridian), pieces_(pieces), goal_(goal), first_(first), rule_(rule) {}

    PatternBegin run(const FibreEnd& before) {
        begin_.cut_because = before.rim >= 0 ? over_rim(before) : along(before);
        return std::move(begin_);
    }

private:
    // From a parallel. Returns in words why it cannot be.
    std::string along(const FibreEnd& before) {
        const Vector3d& p = before.position_mm;
        const Vector3d around = Vector3d(-p.y(), p.x(), 0.0).normalized();
        if (before.tangent.dot(around) < kAlong) {
            return "the one before does not end along a parallel";
        }
        const ConnectingPasses way =
            passes_from(meridian_.foot(std::hypot(p.x(), p.y()), p.z()).arc_mm, goal_);
        if (!way.failure.empty()) {
            return way.failure;
        }
        begin_.end = way.end;
        begin_.azimuth_rad = std::atan2(p.y(), p.x());
        add(way.passes);
        if (goal_[way.end].kind == Kind::Rim) {
            turn_into_pattern(begin_.pieces.back().piece.path.back());
        }
        return "";
    }

    // Over a rim it is turned, straight into the pattern or into passes that lead to it.
    std::string over_rim(const FibreEnd& before) {
        const std::size_t end =
            pieces_.rim_of(0) != nullptr && pieces_.rim_of(0)->id == before.rim ? 0 : 1;
        const Rim& rim = *pieces_.rim_of(end);
        PathPoint from;
        from.position_mm = before.position_mm;
        from.tangent = before.tangent;
        if (!can_turn(rim, crossing_at(rim, from.position_mm, from.tangent), rule_)) {
            return "with the layers before it the fibre cannot be turned over the rim";
        }
        if (goal_[end].kind == Kind::Rim) {
            begin_.end = end;
            turn_into_pattern(from);
            return "";
        }
        return passes_after_rim(end, from);
    }

    // Found backwards, from where the pattern begins to the rim.
    std::string passes_after_rim(std::size_t end, const PathPoint& from) {
        std::array<ConnectingGoal, 2> over_rim{};
        over_rim[end].kind = Kind::Rim;
        for (const std::size_t start : {1 - end, end}) {
            if (goal_[start].kind != Kind::Parallel) {
                continue;
            }
            const ConnectingPasses way = passes_from(goal_[start].arc_mm, over_rim);
            if (!way.failure.empty()) {
                continue;
            }
            const auto passes = other_way_round(way);
            const MeridianStation& first = passes.front().front();
            begin_.end = start;
            begin_.azimuth_rad = turned_azimuth(end, from, first);
            begin_.pieces.push_back(
                pieces_.turn(end, from, swept(first, begin_.azimuth_rad - first.azimuth_rad)));
            add(passes);
            return "";
        }
        return "no friction up to " + fixed(kConnecting * rule_.friction, 3) +
               " leads it from the rim to where the layer begins";
    }

    [[nodiscard]] ConnectingPasses passes_from(double arc_mm,
                                               const std::array<ConnectingGoal, 2>& goal) const {
        ConnectingRequest request;
        request.from_arc_mm = arc_mm;
        request.goal = goal;
        request.friction = kConnecting * rule_.friction;
        request.station_mm = kPatternStation_mm;
        request.can_turn = [this](std::size_t end, const MeridianStation& leaving) {
            const Rim* const rim = pieces_.rim_of(end);
            return rim != nullptr && can_turn(*rim, pieces_.crossing_of(end, leaving, 0.0), rule_);
        };
        return connecting_passes(meridian_, request);
    }

    // Passes from the azimuth where the pattern begins so far, which moves on to their end.
    void add(const std::vector<std::vector<MeridianStation>>& passes) {
        for (const std::vector<MeridianStation>& stations : passes) {
            LaidTurn laid;
            laid.piece =
                pieces_.course(stations, begin_.azimuth_rad - stations.front().azimuth_rad);
            laid.piece.kind = PieceKind::Transition;
            begin_.azimuth_rad += stations.back().azimuth_rad - stations.front().azimuth_rad;
            begin_.pieces.push_back(std::move(laid));
        }
    }

    void turn_into_pattern(const PathPoint& from) {
        const MeridianStation& first = first_[begin_.end];
        begin_.azimuth_rad = turned_azimuth(begin_.end, from, first);
        begin_.pieces.push_back(
            pieces_.turn(begin_.end, from, swept(first, begin_.azimuth_rad - first.azimuth_rad)));
    }

    // Azimuth at which a fibre that leaves over a rim comes back as `first`, hardly with any dwell.
    [[nodiscard]] double turned_azimuth(std::size_t end, const PathPoint& from,
                                        const MeridianStation& first) const {
        const Rim& rim = *pieces_.rim_of(end);
        const PathPoint to = swept(first, -first.azimuth_rad);
        return kLeastDwell_rad - dwell_rad(rim, crossing_at(rim, from.position_mm, from.tangent),
                                           crossing_at(rim, to.position_mm, -to.tangent), rule_);
    }

    const Meridian& meridian_;
    const RevolutionPieces& pieces_;
    const std::array<ConnectingGoal, 2>& goal_;
    const std::array<MeridianStation, 2>& first_;
    const TurnRule& rule_;
    PatternBegin begin_;
};

}  // namespace

PatternBegin begin_after(const FibreEnd& before, const Meridian& meridian,
                         const RevolutionPieces& pieces, const std::array<ConnectingGoal, 2>& goal,
                         const std::array<MeridianStation, 2>& first, const TurnRule& rule) {
    return Beginner(meridian, pieces, goal, first, rule).run(before);
}

}  // namespace meshwind
