#include "winding/revolution/pattern_plan.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/margins.h"
#include "core/parallel.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "winding/laminate/measure_plan.h"
#include "winding/revolution/closed_circuits.h"
#include "winding/revolution/hollow_rim.h"
#include "winding/revolution/hoop_path.h"
#include "winding/revolution/regular_parts.h"
#include "winding/revolution/revolution_pieces.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// A fibre that ends behind a hollow rim is laid on the extension for so many tow widths: it then
// ends where it lies on something, whatever the blocks are off.
constexpr double kRunOutTows = 1.0;

// Where the first circuit or ply begins.
struct PatternStart {
    std::size_t end = 0;  // of the body: the lower is 0
    double azimuth_rad = 0.0;
};

// Stations of a pass: from the lower end up, and from the upper end down.
using BothWays = std::array<std::vector<MeridianStation>, 2>;

// \param wound_mm arc lengths between which there shall be fibre
void measure_between(const PatternTask& task, const MeridianPass& pass,
                     const std::array<double, 2>& wound_mm, Plan& plan) {
    const auto between = [&meridian = task.body.meridian](double from_mm,
                                                          double to_mm) -> PlanZones::Zone {
        return [=, &meridian](const Vector3d& position) {
            const double at =
                meridian.foot(std::hypot(position.x(), position.y()), position.z()).arc_mm;
            return at >= from_mm && at <= to_mm;
        };
    };
    const double tow_width_mm = task.options.tow.width_mm;
    PlanZones zones{between(wound_mm[0], wound_mm[1]), {}, {}};
    regular_parts(task.body, pass, wound_mm, tow_width_mm, zones);
    measure_plan(task.mandrel.surface, task.mandrel.surface, tow_width_mm,
                 task.options.context.seed, zones, plan);
}

void add_laid(const Mandrel& mandrel, LaidTurn laid, Plan& plan) {
    if (laid.rim >= 0) {
        plan.turns.resize(mandrel.rims.size());
        add_turn(std::move(laid), plan);
    } else {
        add_piece(std::move(laid.piece), plan);
    }
}

// Leads on from the fibre of the layer before, where there is one and it can be.
// \param goals where the pattern may begin at either end
// \param first its first station there
// Returns where the pattern begins then.
PatternStart lead_on(const PatternTask& task, const std::array<ConnectingGoal, 2>& goals,
                     const std::array<MeridianStation, 2>& first, Plan& plan) {
    if (!task.options.before) {
        return {};
    }
    PatternBegin begin =
        begin_after(*task.options.before, task.body.meridian, task.pieces, goals, first, task.rule);
    plan.cut_reason = begin.cut_reason;
    plan.continues_fibre = plan.cut_reason.empty();
    if (!plan.continues_fibre) {
        return {};
    }
    for (LaidTurn& laid : begin.pieces) {
        add_laid(task.mandrel, std::move(laid), plan);
    }
    return {begin.end, begin.azimuth_rad};
}

// Where the pattern may begin at an end.
ConnectingGoal goal_at(const WallPass& wall, std::size_t end) {
    if (wall.dwells(end)) {
        return {ConnectingGoal::Kind::Rim, 0.0};
    }
    const MeridianStation& at = end == 0 ? wall.path.stations.front() : wall.path.stations.back();
    return {ConnectingGoal::Kind::Parallel, at.arc_mm};
}

std::int32_t rim_at(const PatternTask& task, const WallPass& wall, std::size_t end) {
    return wall.dwells(end) ? task.body.end[end].rim : -1;
}

// Of the mandrel, over each end; dwell is shared by the rims.
std::array<double, 2> turns_at_ends(const ClosedCircuits& circuits, const RimTurns& turns) {
    const double share = circuits.wall.dwells(0) && circuits.wall.dwells(1) ? 0.5 : 1.0;
    std::array<double, 2> turn{};
    for (std::size_t end = 0; end < 2; ++end) {
        if (circuits.wall.dwells(end)) {
            turn[end] = turns.shortest_rad(end) +
                        std::max(turns.least_dwell_rad(), share * circuits.pattern.dwell_rad);
        }
    }
    return turn;
}

// Per pass of the circuits, by how much it is turned against its way.
// \param ways of the passes \param far_turn_rad turn of the mandrel over the end at which circuits
// do not begin
std::vector<double> turned_rad(const ClosedCircuits& circuits, const PatternStart& start,
                               const std::vector<double>& starts_rad, const BothWays& ways,
                               double far_turn_rad) {
    std::vector<double> turned(2 * starts_rad.size());
    for (std::size_t i = 0; i < starts_rad.size(); ++i) {
        const double begins = start.azimuth_rad + starts_rad[i];
        double returns = begins + circuits.laid.turn_rad() + far_turn_rad;
        if (!circuits.wall.dwells(start.end) && i + 1 < starts_rad.size()) {
            // What the next circuit is off its place is made up at the other end.
            returns += starts_rad[i + 1] - starts_rad[i] - circuits.pattern.turn_rad;
        }
        turned[2 * i] = begins - ways[start.end].front().azimuth_rad;
        turned[2 * i + 1] = returns - ways[1 - start.end].front().azimuth_rad;
    }
    return turned;
}

// The passes of circuits that begin at an end. \param tied_on the fibre begins with the first one
std::vector<Piece> passes_of(const PatternTask& task, const ClosedCircuits& circuits,
                             std::size_t start, const BothWays& ways,
                             const std::vector<double>& turned, bool tied_on) {
    std::vector<Piece> passes(turned.size());
    parallel_for(passes.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t from = i % 2 == 0 ? start : 1 - start;
            passes[i] =
                task.pieces.course(tied_on && i == 0 && in_air(circuits.laid, start)
                                       ? tied_on_way(task.body.meridian, circuits.wall.path,
                                                     circuits.laid, from, task.pieces.station_mm())
                                       : ways[from],
                                   turned[i]);
            passes[i].start_rim = rim_at(task, circuits.wall, from);
            passes[i].end_rim = rim_at(task, circuits.wall, 1 - from);
        }
    });
    return passes;
}

// Adds the circuits that begin there. Returns which piece is the last pass.
std::size_t lay_circuits(const PatternTask& task, const ClosedCircuits& circuits,
                         const PatternStart& start, const std::vector<double>& starts_rad,
                         RimTurns& turns, Plan& plan) {
    const std::size_t far = 1 - start.end;
    const RevolutionPieces& pieces = task.pieces;
    const BothWays ways{circuits.laid.stations, way_back(circuits.laid)};
    const std::vector<double> turned =
        turned_rad(circuits, start, starts_rad, ways, turns_at_ends(circuits, turns)[far]);
    std::vector<Piece> passes =
        passes_of(task, circuits, start.end, ways, turned, plan.pieces.empty());
    plan.turns.resize(task.mandrel.rims.size());
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const std::size_t end = i % 2 == 0 ? far : start.end;
        add_piece(std::move(passes[i]), plan);
        if (circuits.wall.dwells(end) && i + 1 < passes.size()) {
            add_laid(task.mandrel,
                     turns.turn(end, pieces.crossing_of(end, ways[1 - end].back(), turned[i]),
                                pieces.crossing_of(end, ways[end].front(), turned[i + 1])),
                     plan);
        }
    }
    const std::size_t last = plan.pieces.size() - 1;
    if (in_air(circuits.laid, start.end)) {
        add_laid(task.mandrel,
                 pieces.run_out(start.end,
                                pieces.crossing_of(start.end, ways[far].back(), turned.back()),
                                kRunOutTows * task.options.tow.width_mm),
                 plan);
    }
    plan.courses = static_cast<int>(passes.size());
    return last;
}

// Returns nothing, or in words why the machine does not wind the first circuits. It is not asked
// while their pins are yet to be put on. \param plan what lies before the pattern
std::string why_not_wound(const PatternTask& task, const ClosedCircuits& circuits,
                          const PatternStart& start, RimTurns& turns, const Plan& plan) {
    constexpr std::size_t kCircuits = 3;
    if (!task.options.winds || !turns.pins().empty()) {
        return {};
    }
    Plan trial = plan;
    std::vector<double> starts = circuit_starts_rad(circuits.pattern, circuits.lattice);
    starts.resize(std::min(kCircuits, starts.size()));
    lay_circuits(task, circuits, start, starts, turns, trial);
    const CourseFault why = task.options.winds(std::span(trial.pieces).subspan(plan.pieces.size()));
    return why == CourseFault::None ? std::string()
                                    : "a circuit at " + degrees(circuits.wall.angle_rad, 1) +
                                          " cannot be wound: " + name_of(why);
}

// From where the fibre ends, turned on over its last rim, to where its pattern began.
// \param first, last courses of the pattern
double closure_rad(const ClosedCircuits& circuits, const std::vector<double>& starts_rad,
                   const Piece& first, const Piece& last, std::size_t start, double last_turn_rad) {
    const auto azimuth = [](const PathPoint& point) {
        return std::atan2(point.position_mm.y(), point.position_mm.x());
    };
    const double moved_rad =
        starts_rad[starts_rad.size() - static_cast<std::size_t>(circuits.pattern.circuits)];
    const double end = azimuth(last.path.back()) + last_turn_rad - moved_rad;
    const bool tied_on = first.string.gap_mm.front() <= 0.0;
    const double begin =
        azimuth(first.path.front()) -
        (tied_on ? tied_on_beside_rad(circuits.wall.path, circuits.laid, start) : 0.0);
    return std::abs(std::remainder(end - begin, 2.0 * kPi));
}

// The whole pattern.
void lay_pattern(const PatternTask& task, const ClosedCircuits& circuits, const PatternStart& start,
                 RimTurns& turns, Plan& plan) {
    std::vector<double> starts = circuit_starts_rad(circuits.pattern, circuits.lattice);
    const std::size_t first = plan.pieces.size();
    const std::size_t last = lay_circuits(task, circuits, start, starts, turns, plan);
    plan.pins = turns.pins();
    plan.pieces.front().starts_fibre = true;
    plan.fibres = 1;
    const std::array<double, 2> turn = turns_at_ends(circuits, turns);
    const WallPass& wall = circuits.wall;
    LaidPattern& laid = plan.details.emplace<LaidPattern>();
    laid.pattern = circuits.pattern;
    laid.angle_rad = wall.angle_rad;
    laid.slip_ratio =
        std::abs(wall.slip.below) > std::abs(wall.slip.above) ? wall.slip.below : wall.slip.above;
    laid.closure_rad = closure_rad(circuits, starts, plan.pieces[first], plan.pieces[last],
                                   start.end, turn[start.end]);
    laid.band_offset_mm = circuits.pattern.step_rad * wall.sparsest_mm(task.widest_radius_mm);
    laid.interlacing =
        interlacing_of(circuits.pattern, circuits.laid.turn_rad(), turn[1 - start.end]);
    laid.starts_rad = std::move(starts);
    laid.lattice = circuits.lattice;
}

Plan empty_plan() {
    Plan plan;
    plan.planner = Planner::Pattern;
    return plan;
}

Plan plan_circuits(const PatternTask& task) {
    Plan plan = empty_plan();
    const std::unique_ptr<RimTurns> turns =
        task.options.turns(task.options.tow, task.options.turn.extension_mm);
    const ClosedCircuits circuits = close_circuits(task, *turns);
    if (!circuits.failure.empty()) {
        plan.failure = circuits.failure;
        return plan;
    }
    const PatternStart start =
        lead_on(task, {goal_at(circuits.wall, 0), goal_at(circuits.wall, 1)},
                {circuits.laid.stations.front(), way_back(circuits.laid).front()}, plan);
    plan.failure = why_not_wound(task, circuits, start, *turns, plan);
    if (!plan.failure.empty()) {
        return plan;
    }
    lay_pattern(task, circuits, start, *turns, plan);
    // At a turn of its own the band is whole as far as its middle.
    const MeridianPass& wall = circuits.wall.path;
    measure_between(task, wall, {wall.stations.front().arc_mm, wall.stations.back().arc_mm}, plan);
    return plan;
}

// What of the body hoops hold on; empty where it is no cylinder there.
// \param steering slip ratio with which hoops turn into a helix
CylinderPart hoop_part(const PatternTask& task, double steering) {
    const Meridian& meridian = task.body.meridian;
    const PatternOptions& options = task.options;
    const CylinderPart asked_for =
        options.hoop_z_mm
            ? cylinder_between(meridian, (*options.hoop_z_mm)[0], (*options.hoop_z_mm)[1])
            : cylinder_at(meridian, task.widest_mm);
    return level_part(meridian, asked_for, options.tow.width_mm,
                      options.tow.friction.holds() - steering);
}

Plan plan_hoops(const PatternTask& task) {
    Plan plan = empty_plan();
    const Meridian& meridian = task.body.meridian;
    const double steering = task.options.tow.friction.share(margin::kHoopSteering);
    const CylinderPart part = hoop_part(task, steering);
    if (part.to_mm == part.from_mm) {
        plan.failure = "hoops hold on a cylinder, and at its widest place, z " +
                       fixed(meridian.at(task.widest_mm).z_mm, 1) + " mm, the body is none";
        return plan;
    }
    const auto ply = [&](bool downward) {
        return hoop_ply(meridian, part, task.options.tow.width_mm, steering,
                        task.pieces.station_mm(), downward);
    };
    const std::array first{ply(false).front(), ply(true).front()};
    const PatternStart start =
        lead_on(task,
                {ConnectingGoal{ConnectingGoal::Kind::Parallel, first[0].arc_mm},
                 ConnectingGoal{ConnectingGoal::Kind::Parallel, first[1].arc_mm}},
                first, plan);
    const int plies = std::max(1, static_cast<int>(std::lround(task.options.layers)));
    double begin_rad = start.azimuth_rad;
    bool downward = start.end == 1;
    for (int i = 0; i < plies; ++i, downward = !downward) {
        const std::vector<MeridianStation> stations = ply(downward);
        add_piece(task.pieces.course(stations, begin_rad), plan);
        begin_rad += stations.back().azimuth_rad;
    }
    plan.pieces.front().starts_fibre = true;
    plan.courses = plies;
    plan.fibres = 1;
    plan.turns.resize(task.mandrel.rims.size());
    measure_between(task, {}, {part.from_mm, part.to_mm}, plan);
    return plan;
}

}  // namespace

Plan plan_pattern(const Mandrel& mandrel, const BodyOfRevolution& body,
                  const PatternOptions& options) {
    const TurnRule rule{options.tow.friction, options.turn.extension_mm, options.tow.width_mm};
    const RevolutionPieces pieces(mandrel, body, rule);
    const double widest_mm = body.meridian.widest_mm();
    const PatternTask task{
        mandrel, body, options, rule, pieces, widest_mm, body.meridian.at(widest_mm).radius_mm};
    return options.kind == PatternKind::Hoop ? plan_hoops(task) : plan_circuits(task);
}

}  // namespace meshwind
