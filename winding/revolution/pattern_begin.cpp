#include "winding/revolution/pattern_begin.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

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

// What the fibre is led on to, and over which body.
struct BeginTask {
    const Meridian& meridian;
    const RevolutionPieces& pieces;
    const std::array<ConnectingGoal, 2>& goal;
    const std::array<MeridianStation, 2>& first;
    const TurnRule& rule;
};

PatternBegin cut(const std::string& because) {
    PatternBegin begin;
    begin.cut_reason = because;
    return begin;
}

ConnectingPasses passes_from(const BeginTask& task, double arc_mm,
                             const std::array<ConnectingGoal, 2>& goal) {
    ConnectingRequest request;
    request.from_arc_mm = arc_mm;
    request.goal = goal;
    request.friction = task.rule.friction.share(margin::kConnectingSteering);
    request.station_mm = task.pieces.station_mm();
    request.can_turn = [&task](std::size_t end, const MeridianStation& leaving) {
        const Rim* const rim = task.pieces.rim_of(end);
        return rim != nullptr &&
               can_turn(*rim, task.pieces.crossing_of(end, leaving, 0.0), task.rule);
    };
    return connecting_passes(task.meridian, request);
}

// Of a pass that begins or ends at the rim of an end, over which it is to be turned: straight
// through the air where the rim is a hollow. False where it cannot be turned so.
bool lift(const BeginTask& task, std::size_t end, bool upward, std::vector<MeridianStation>& pass) {
    if (rim_kink_rad(task.meridian, end == 1) < kMinRimKink_rad) {
        return true;
    }
    const auto turned_round = [](std::vector<MeridianStation> stations) {
        return way_back({std::move(stations), MeridianStop::End, MeridianStop::End});
    };
    std::vector<MeridianStation> way = upward ? pass : turned_round(pass);
    if (lift_over_rim(task.meridian, end == 1, task.pieces.station_mm(), way) ==
        RimLift::NeverOnWall) {
        return false;
    }
    pass = upward ? way : turned_round(way);
    const MeridianStation& at_rim = upward == (end == 1) ? pass.back() : pass.front();
    return can_turn(*task.pieces.rim_of(end), task.pieces.crossing_of(end, at_rim, 0.0), task.rule);
}

// Passes from the azimuth where the pattern begins so far, which moves on to their end. Returns
// what the stations of the last one are turned by.
double add_passes(const RevolutionPieces& pieces,
                  const std::vector<std::vector<MeridianStation>>& passes, PatternBegin& begin) {
    double turn_rad = 0.0;
    for (const std::vector<MeridianStation>& stations : passes) {
        LaidTurn laid;
        turn_rad = begin.azimuth_rad - stations.front().azimuth_rad;
        laid.piece = pieces.course(stations, turn_rad);
        laid.piece.kind = PieceKind::Transition;
        begin.azimuth_rad += stations.back().azimuth_rad - stations.front().azimuth_rad;
        begin.pieces.push_back(std::move(laid));
    }
    return turn_rad;
}

// Over a rim, to come back as `first`, hardly with any dwell. The pattern begins at the azimuth of
// that.
void add_turn_to(const BeginTask& task, std::size_t end, const RimCrossing& from,
                 const MeridianStation& first, PatternBegin& begin) {
    const RimCrossing to = task.pieces.crossing_of(end, first, -first.azimuth_rad);
    begin.azimuth_rad = kMinDwell_rad - dwell_rad(*task.pieces.rim_of(end), from, to, task.rule);
    begin.pieces.push_back(task.pieces.turn(
        end, from, task.pieces.crossing_of(end, first, begin.azimuth_rad - first.azimuth_rad)));
}

// From a parallel.
PatternBegin begin_along(const BeginTask& task, const FibreEnd& before) {
    const Vector3d& p = before.position_mm;
    const Vector3d around = Vector3d(-p.y(), p.x(), 0.0).normalized();
    if (before.tangent.dot(around) < kAlong) {
        return cut("the one before does not end along a parallel");
    }
    ConnectingPasses way =
        passes_from(task, task.meridian.foot(std::hypot(p.x(), p.y()), p.z()).arc_mm, task.goal);
    if (!way.failure.empty()) {
        return cut(way.failure);
    }
    const bool turns = task.goal[way.end].kind == Kind::Rim;
    if (turns && !lift(task, way.end, way.end == 1, way.passes.back())) {
        return cut(kNoTurn);
    }
    PatternBegin begin;
    begin.end = way.end;
    begin.azimuth_rad = std::atan2(p.y(), p.x());
    const double turn_rad = add_passes(task.pieces, way.passes, begin);
    if (turns) {
        add_turn_to(task, way.end,
                    task.pieces.crossing_of(way.end, way.passes.back().back(), turn_rad),
                    task.first[way.end], begin);
    }
    return begin;
}

// Passes found backwards, from where the pattern begins to the rim.
PatternBegin begin_after_rim(const BeginTask& task, std::size_t end, const RimCrossing& from) {
    std::array<ConnectingGoal, 2> over_rim{};
    over_rim[end].kind = Kind::Rim;
    for (const std::size_t start : {1 - end, end}) {
        if (task.goal[start].kind != Kind::Parallel) {
            continue;
        }
        const ConnectingPasses way = passes_from(task, task.goal[start].arc_mm, over_rim);
        if (!way.failure.empty()) {
            continue;
        }
        auto passes = other_way_round(way);
        if (!lift(task, end, end == 0, passes.front())) {
            continue;
        }
        PatternBegin begin;
        begin.end = start;
        add_turn_to(task, end, from, passes.front().front(), begin);
        add_passes(task.pieces, passes, begin);
        return begin;
    }
    return cut("no friction up to " +
               fixed(task.rule.friction.share(margin::kConnectingSteering), 3) +
               " leads it from the rim to where the layer begins");
}

// Over a rim it is turned, straight into the pattern or into passes that lead to it.
PatternBegin begin_over_rim(const BeginTask& task, const FibreEnd& before) {
    const RevolutionPieces& pieces = task.pieces;
    const std::size_t end =
        pieces.rim_of(0) != nullptr && pieces.rim_of(0)->id == before.rim ? 0 : 1;
    const Rim& rim = *pieces.rim_of(end);
    const RimCrossing leaves = before.in_air
                                   ? crossing_in_air(rim, before.position_mm, before.tangent)
                                   : crossing_at(rim, before.position_mm, before.tangent);
    if (!can_turn(rim, leaves, task.rule)) {
        return cut(kNoTurn);
    }
    if (task.goal[end].kind != Kind::Rim) {
        return begin_after_rim(task, end, leaves);
    }
    PatternBegin begin;
    begin.end = end;
    add_turn_to(task, end, leaves, task.first[end], begin);
    return begin;
}

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
    const BeginTask task{meridian, pieces, goal, first, rule};
    return before.rim >= 0 ? begin_over_rim(task, before) : begin_along(task, before);
}

}  // namespace meshwind
