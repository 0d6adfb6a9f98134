#include "winding/revolution/pattern_begin.h"

#include <cmath>
#include <utility>

#include "core/margins.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "winding/revolution/hollow_rim.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Kind = ConnectingGoal::Kind;

constexpr const char* kNoTurn = "with the layers before it the fibre cannot be turned over the rim";

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
        ConnectingPasses way =
            passes_from(meridian_.foot(std::hypot(p.x(), p.y()), p.z()).arc_mm, goal_);
        if (!way.failure.empty()) {
            return way.failure;
        }
        const bool turns = goal_[way.end].kind == Kind::Rim;
        if (turns && !lift(way.end, way.end == 1, way.passes.back())) {
            return kNoTurn;
        }
        begin_.end = way.end;
        begin_.azimuth_rad = std::atan2(p.y(), p.x());
        const double turn_rad = add(way.passes);
        if (turns) {
            turn_into_pattern(pieces_.crossing_of(way.end, way.passes.back().back(), turn_rad));
        }
        return "";
    }

    // Over a rim it is turned, straight into the pattern or into passes that lead to it.
    std::string over_rim(const FibreEnd& before) {
        const std::size_t end =
            pieces_.rim_of(0) != nullptr && pieces_.rim_of(0)->id == before.rim ? 0 : 1;
        const Rim& rim = *pieces_.rim_of(end);
        const RimCrossing leaves = before.in_air
                                       ? crossing_in_air(rim, before.position_mm, before.tangent)
                                       : crossing_at(rim, before.position_mm, before.tangent);
        if (!can_turn(rim, leaves, rule_)) {
            return kNoTurn;
        }
        if (goal_[end].kind == Kind::Rim) {
            begin_.end = end;
            turn_into_pattern(leaves);
            return "";
        }
        return passes_after_rim(end, leaves);
    }

    // Found backwards, from where the pattern begins to the rim.
    std::string passes_after_rim(std::size_t end, const RimCrossing& from) {
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
            auto passes = other_way_round(way);
            if (!lift(end, end == 0, passes.front())) {
                continue;
            }
            const MeridianStation& first = passes.front().front();
            begin_.end = start;
            begin_.azimuth_rad = turned_azimuth(end, from, first);
            begin_.pieces.push_back(pieces_.turn(
                end, from,
                pieces_.crossing_of(end, first, begin_.azimuth_rad - first.azimuth_rad)));
            add(passes);
            return "";
        }
        return "no friction up to " + fixed(rule_.friction.share(margin::kConnectingSteering), 3) +
               " leads it from the rim to where the layer begins";
    }

    [[nodiscard]] ConnectingPasses passes_from(double arc_mm,
                                               const std::array<ConnectingGoal, 2>& goal) const {
        ConnectingRequest request;
        request.from_arc_mm = arc_mm;
        request.goal = goal;
        request.friction = rule_.friction.share(margin::kConnectingSteering);
        request.station_mm = pieces_.station_mm();
        request.can_turn = [this](std::size_t end, const MeridianStation& leaving) {
            const Rim* const rim = pieces_.rim_of(end);
            return rim != nullptr && can_turn(*rim, pieces_.crossing_of(end, leaving, 0.0), rule_);
        };
        return connecting_passes(meridian_, request);
    }

    // Of a pass that begins or ends at the rim of an end, over which it is to be turned: straight
    // through the air where the rim is a hollow. False where it cannot be turned so.
    bool lift(std::size_t end, bool upward, std::vector<MeridianStation>& pass) const {
        if (rim_kink_rad(meridian_, end == 1) < kLeastRimKink_rad) {
            return true;
        }
        const auto turned_round = [](std::vector<MeridianStation> stations) {
            return way_back({std::move(stations), MeridianStop::End, MeridianStop::End});
        };
        std::vector<MeridianStation> way = upward ? pass : turned_round(pass);
        if (lift_over_rim(meridian_, end == 1, pieces_.station_mm(), way) == RimLift::NeverOnWall) {
            return false;
        }
        pass = upward ? way : turned_round(way);
        const MeridianStation& at_rim = upward == (end == 1) ? pass.back() : pass.front();
        return can_turn(*pieces_.rim_of(end), pieces_.crossing_of(end, at_rim, 0.0), rule_);
    }

    // Passes from the azimuth where the pattern begins so far, which moves on to their end. Returns
    // what the stations of the last one are turned by.
    double add(const std::vector<std::vector<MeridianStation>>& passes) {
        double turn_rad = 0.0;
        for (const std::vector<MeridianStation>& stations : passes) {
            LaidTurn laid;
            turn_rad = begin_.azimuth_rad - stations.front().azimuth_rad;
            laid.piece = pieces_.course(stations, turn_rad);
            laid.piece.kind = PieceKind::Transition;
            begin_.azimuth_rad += stations.back().azimuth_rad - stations.front().azimuth_rad;
            begin_.pieces.push_back(std::move(laid));
        }
        return turn_rad;
    }

    void turn_into_pattern(const RimCrossing& from) {
        const MeridianStation& first = first_[begin_.end];
        begin_.azimuth_rad = turned_azimuth(begin_.end, from, first);
        begin_.pieces.push_back(pieces_.turn(
            begin_.end, from,
            pieces_.crossing_of(begin_.end, first, begin_.azimuth_rad - first.azimuth_rad)));
    }

    // Azimuth at which a fibre that leaves over a rim comes back as `first`, hardly with any dwell.
    [[nodiscard]] double turned_azimuth(std::size_t end, const RimCrossing& from,
                                        const MeridianStation& first) const {
        const RimCrossing to = pieces_.crossing_of(end, first, -first.azimuth_rad);
        return kLeastDwell_rad - dwell_rad(*pieces_.rim_of(end), from, to, rule_);
    }

    const Meridian& meridian_;
    const RevolutionPieces& pieces_;
    const std::array<ConnectingGoal, 2>& goal_;
    const std::array<MeridianStation, 2>& first_;
    const TurnRule& rule_;
    PatternBegin begin_;
};

}  // namespace

FibreEnd fibre_end_of(const Plan& plan) {
    const Piece& last = plan.pieces.back();
    const bool runs_out = last.string.gap_mm.front() > 0.0;
    const Piece& course = runs_out ? plan.pieces[plan.pieces.size() - 2] : last;
    const PathPoint& at = course.path.back();
    const Vector3d fibre =
        runs_out ? string_point(at, 0.0, course.string.slope.back()).tangent : at.tangent;
    return {at.position_mm, fibre, last.end_rim, runs_out};
}

PatternBegin begin_after(const FibreEnd& before, const Meridian& meridian,
                         const RevolutionPieces& pieces, const std::array<ConnectingGoal, 2>& goal,
                         const std::array<MeridianStation, 2>& first, const TurnRule& rule) {
    return Beginner(meridian, pieces, goal, first, rule).run(before);
}

}  // namespace meshwind
