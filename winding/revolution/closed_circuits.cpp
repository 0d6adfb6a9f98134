#include "winding/revolution/closed_circuits.h"

#include <utility>

#include "core/error.h"
#include "core/margins.h"
#include "core/roots.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "winding/revolution/aim_pass.h"
#include "winding/revolution/hollow_rim.h"
#include "winding/revolution/regular_parts.h"
#include "winding/revolution/steered_pass.h"

namespace meshwind {
namespace {

// A pass that meets no end within this circles for ever.
constexpr double kLongest_mm = 1e5;

// A closed pattern may change the winding angle by so much.
constexpr double kMaxAngle_rad = rad_from_deg(3.0);

constexpr double kSlope_rad = 1e-4;

// Patterns whose bands, at the angle that closes them, leave gaps are looked for again so often. No
// tow keeps its width to this share: what another angle changes is more.
constexpr int kMaxTries = 6;
constexpr double kNoGap = 1e-3;

// Closure in rad: far below what any axis resolves.
constexpr double kClosed_rad = 1e-12;

// Turns at given radii at both ends are met to 1e-6 mm; with that a secant comes so near to the
// turn of a circuit, and the slip stays as it is for what is left.
constexpr double kNearlyClosed_rad = 1e-6;

struct AimedPass {
    WallPass wall{};
    std::string failure{};  // not empty: no pass leads from one end to the other as is asked
};

ClosedCircuits failed(std::string words) {
    ClosedCircuits circuits;
    circuits.failure = std::move(words);
    return circuits;
}

MeridianPass path_at(const PatternTask& task, double angle_rad, const HalfSlips& slip) {
    return pass_through(task.body.meridian, task.widest_mm, angle_rad, slip,
                        task.pieces.station_mm(), kLongest_mm);
}

// Where the band touches the opening of an end, or the pole.
double touching_mm(const PatternTask& task, std::size_t end) {
    const Rim* const rim = task.pieces.rim_of(end);
    return (rim != nullptr ? rim->radius_mm : 0.0) + 0.5 * task.options.tow.width_mm;
}

// Helical: the steering with which a pass at the angle asked for comes to both ends.
AimedPass aimed_at_angle(const PatternTask& task) {
    const PassAim aim = aim_at_ends(
        task.body, {.angle_rad = task.options.angle_rad,
                    .most_slip = task.options.tow.friction.share(margin::kPatternSteering),
                    .touching_mm = {touching_mm(task, 0), touching_mm(task, 1)}});
    return {
        .wall = {task.options.angle_rad, aim.slip, path_at(task, task.options.angle_rad, aim.slip)},
        .failure = aim.failure};
}

// From one opening to the other, each turned at farther off by so much.
SteeringFinding between_openings(const PatternTask& task, double off_mm) {
    return steer_between(task.body.meridian,
                         {.lower_mm = touching_mm(task, 0) + off_mm,
                          .upper_mm = touching_mm(task, 1) + off_mm,
                          .most_slip = task.options.tow.friction.share(margin::kPatternSteering),
                          .station_mm = task.pieces.station_mm(),
                          .longest_mm = kLongest_mm});
}

WallPass wall_pass_of(const SteeredPass& steered) {
    return {steered.angle_rad, {steered.slip_ratio, steered.slip_ratio}, steered.pass};
}

// Polar: winding angle and steering with which the band touches the openings of both ends.
AimedPass aimed_at_openings(const PatternTask& task) {
    for (std::size_t end = 0; end < 2; ++end) {
        const double turn_mm = touching_mm(task, end);
        if (turn_mm >= task.widest_radius_mm) {
            return {.failure = "a polar winding turns round the openings, and the " +
                               std::string(end == 0 ? "lower" : "upper") +
                               " end has none that is smaller than the body: radius " +
                               fixed(turn_mm, 1) + " of " + fixed(task.widest_radius_mm, 1) +
                               " mm; use \"helical\""};
        }
    }
    const SteeringFinding steering = between_openings(task, 0.0);
    if (!steering.found) {
        return {.failure = "the openings are too different: with the friction of " +
                           fixed(task.options.tow.friction.share(margin::kPatternSteering), 3) +
                           " a band that touches the lower one turns at radius " +
                           fixed(steering.reached_mm, 1) + " mm at the upper end, where " +
                           fixed(touching_mm(task, 1), 1) + " mm would touch it"};
    }
    return {.wall = wall_pass_of(*steering.found)};
}

// The pass with ends that go straight over hollow rims, unless its turns leave them on the wall.
LaidPass laid_between_turns(const PatternTask& task, const WallPass& wall, const RimTurns& turns) {
    if (!turns.lifts_over_hollow_rims()) {
        return {.pass = wall.path};
    }
    return lifted_over_rims(task.body.meridian, wall.path,
                            {.angle_rad = wall.angle_rad,
                             .most_gap_mm = task.options.tow.bridging_tolerance_mm,
                             .station_mm = task.pieces.station_mm()});
}

// Adds the ends at which the fibre dwells to the turns. Returns nothing, or in words why an end of
// the pass cannot be turned at.
std::string add_ends(const PatternTask& task, const WallPass& wall, const MeridianPass& laid,
                     RimTurns& turns) {
    for (std::size_t end = 0; end < 2; ++end) {
        const MeridianStop stop = end == 0 ? wall.path.lower : wall.path.upper;
        const std::string name = end == 0 ? "lower" : "upper";
        if (stop == MeridianStop::Length) {
            return "a fibre at " + degrees(wall.angle_rad) + " never reaches the body's " + name +
                   " end";
        }
        if (stop == MeridianStop::Hoop) {
            continue;
        }
        const Rim* const rim = task.pieces.rim_of(end);
        if (rim == nullptr) {
            return "a fibre at " + degrees(wall.angle_rad) + " runs over the " + name +
                   " pole; a larger angle turns before it";
        }
        const MeridianStation& at = end == 0 ? laid.stations.front() : laid.stations.back();
        std::string why =
            turns.add({end, *rim, task.pieces.crossing_of(end, at, 0.0), wall.angle_rad});
        if (!why.empty()) {
            return why;
        }
    }
    return wall.dwells(0) || wall.dwells(1) ? std::string() : turns.why_no_ends(wall.angle_rad);
}

// Turn of the mandrel in a circuit without dwell.
double circuit_rad(const WallPass& wall, const MeridianPass& laid, const RimTurns& turns) {
    double turn = 2.0 * laid.turn_rad();
    for (std::size_t end = 0; end < 2; ++end) {
        turn += wall.dwells(end) ? turns.shortest_rad(end) : 0.0;
    }
    return turn;
}

// How much the turn of a circuit changes within kMaxAngle_rad, by its slope.
double most_change_rad(const PatternTask& task, const WallPass& wall) {
    const double more = path_at(task, wall.angle_rad + kSlope_rad, wall.slip).turn_rad();
    const double less = path_at(task, wall.angle_rad - kSlope_rad, wall.slip).turn_rad();
    return std::min(kPi, 2.0 * std::abs(more - less) / (2.0 * kSlope_rad) * kMaxAngle_rad);
}

CircuitToClose circuit_to_close(const PatternTask& task, const WallPass& wall,
                                const MeridianPass& laid, const RimTurns& turns) {
    const bool dwell = wall.dwells(0) || wall.dwells(1);
    CircuitToClose circuit;
    circuit.turn_rad = circuit_rad(wall, laid, turns);
    circuit.most_change_rad = dwell ? 0.0 : most_change_rad(task, wall);
    circuit.dwelling_ends = static_cast<int>(wall.dwells(0)) + static_cast<int>(wall.dwells(1));
    circuit.band_mm = task.options.tow.width_mm;
    circuit.mm_per_rad = wall.sparsest_mm(task.widest_radius_mm);
    circuit.layers =
        task.options.lattice ? 1 : std::max(1, static_cast<int>(std::lround(task.options.layers)));
    return circuit;
}

FoundPattern pattern_of(const PatternOptions& options, const CircuitToClose& circuit,
                        RimTurns& turns) {
    try {
        const auto find = [&](const PatternConstraints& wish) {
            return options.lattice ? find_wished_lattice(circuit, *options.lattice, wish)
                                   : find_wished_pattern(circuit, wish);
        };
        return turns.find(options.wish, find);
    } catch (const InputError& error) {
        return {std::nullopt, std::string("no pattern can be looked for: ") + error.what()};
    }
}

// Between bands, as they are to lie.
double offset_mm(const PatternOptions& options) {
    return options.wish.band_offset_mm > 0.0 ? options.wish.band_offset_mm : options.tow.width_mm;
}

// The pass whose circuits turn the mandrel by just so much, by another winding angle; none where
// none within kMaxAngle_rad does. Where a polar winding is steered, both turns give way by the
// same length first, and the slip with them.
std::optional<WallPass> closed_by_angle(const PatternTask& task, const WallPass& asked,
                                        double turn_rad) {
    WallPass wall = asked;
    if (task.options.kind == PatternKind::Polar && asked.slip.above != 0.0) {
        const double most_mm = kMaxAngle_rad * task.widest_radius_mm * std::cos(asked.angle_rad);
        const auto by_turns = [&](double off_mm) {
            const SteeringFinding steering = between_openings(task, off_mm);
            if (steering.found) {
                wall = wall_pass_of(*steering.found);
            }
            return 2.0 * wall.path.turn_rad() - turn_rad;
        };
        if (!secant_root(by_turns, kSlope_rad * task.widest_radius_mm, most_mm,
                         kNearlyClosed_rad)) {
            return std::nullopt;
        }
    }
    const double wanted_rad = wall.angle_rad;
    const auto by_angle = [&](double off_rad) {
        wall.angle_rad = wanted_rad + off_rad;
        wall.path = path_at(task, wall.angle_rad, wall.slip);
        return 2.0 * wall.path.turn_rad() - turn_rad;
    };
    const bool closed = secant_root(by_angle, kSlope_rad, kMaxAngle_rad, 1e3 * kClosed_rad);
    const bool turns =
        wall.path.lower == MeridianStop::Hoop && wall.path.upper == MeridianStop::Hoop;
    if (!closed || !turns) {
        return std::nullopt;
    }
    return wall;
}

// The best pattern for a circuit, and the pass at the angle that closes it.
ClosedCircuits best_closed_by_angle(const PatternTask& task, const WallPass& asked,
                                    const CircuitToClose& circuit, RimTurns& turns) {
    FoundPattern found = pattern_of(task.options, circuit, turns);
    if (!found.pattern) {
        return failed(std::move(found.failure));
    }
    std::optional<WallPass> wall = closed_by_angle(task, asked, found.pattern->turn_rad);
    if (!wall) {
        return failed("no winding angle within " + degrees(kMaxAngle_rad) + " of " +
                      degrees(asked.angle_rad) + " closes a pattern of " +
                      std::to_string(found.pattern->circuits) +
                      " circuits; another angle or tow width would");
    }
    ClosedCircuits circuits;
    circuits.wall = std::move(*wall);
    circuits.pattern = *found.pattern;
    return circuits;
}

// Circuits that turn back by themselves close by another angle, at which bands may lie farther
// apart: a pattern is then looked for that closes the wall with these. Where none is found the
// first stands, with its gaps.
ClosedCircuits closed_without_gaps(const PatternTask& task, const WallPass& asked,
                                   CircuitToClose circuit, RimTurns& turns) {
    ClosedCircuits best;
    bool closed = false;
    for (int tries = 1; !closed && tries <= kMaxTries; ++tries) {
        ClosedCircuits found = best_closed_by_angle(task, asked, circuit, turns);
        if (!found.failure.empty()) {
            if (tries == 1) {
                return found;
            }
            break;
        }
        circuit.mm_per_rad = found.wall.sparsest_mm(task.widest_radius_mm);
        const double around_mm = 2.0 * kPi * circuit.mm_per_rad * circuit.layers;
        closed = task.options.lattice || task.options.wish.circuits > 0 ||
                 static_cast<double>(found.pattern.circuits) * offset_mm(task.options) >=
                     (1.0 - kNoGap) * around_mm;
        if (closed || tries == 1) {
            best = std::move(found);
        }
    }
    circuit.mm_per_rad = best.wall.sparsest_mm(task.widest_radius_mm);
    best.laid = best.wall.path;
    best.pattern = with_bands_of(circuit, best.pattern);
    return best;
}

// Circuits that turn over a rim close by their dwell there.
ClosedCircuits closed_by_dwell(const PatternTask& task, WallPass wall, MeridianPass laid,
                               const CircuitToClose& circuit, RimTurns& turns) {
    FoundPattern found = pattern_of(task.options, circuit, turns);
    if (!found.pattern) {
        return failed(std::move(found.failure));
    }
    ClosedCircuits circuits;
    circuits.wall = std::move(wall);
    circuits.laid = std::move(laid);
    circuits.pattern = *found.pattern;
    return circuits;
}

ClosedCircuits closed_by_pattern(const PatternTask& task, WallPass wall, MeridianPass laid,
                                 RimTurns& turns) {
    CircuitToClose circuit = circuit_to_close(task, wall, laid, turns);
    const bool dwell = circuit.dwelling_ends > 0;
    ClosedCircuits circuits =
        dwell ? closed_by_dwell(task, std::move(wall), std::move(laid), circuit, turns)
              : closed_without_gaps(task, wall, circuit, turns);
    if (!circuits.failure.empty() || !task.options.lattice) {
        return circuits;
    }
    circuit.mm_per_rad = circuits.wall.sparsest_mm(task.widest_radius_mm);
    circuits.lattice =
        laid_lattice(circuits.pattern, circuit, *task.options.lattice, task.options.wish);
    if (circuits.lattice->series > 1 && !dwell) {
        return failed(
            "the bands of a rib are set side by side by dwelling at a rim, and the "
            "fibre turns by itself at both ends; ask for one series");
    }
    return circuits;
}

// Where the band turns it counts as far as its middle. Returns nothing, or in words that it covers
// too little.
std::string why_not_enough(const PatternTask& task, const MeridianPass& path) {
    const double share = share_between(task.body.meridian,
                                       {path.stations.front().arc_mm, path.stations.back().arc_mm});
    return share >= task.options.least_covered ? std::string()
                                               : "a pattern that turns back there covers " +
                                                     percent(share, 1) + " of the wall at most";
}

}  // namespace

ClosedCircuits close_circuits(const PatternTask& task, RimTurns& turns) {
    AimedPass aimed =
        task.options.kind == PatternKind::Polar ? aimed_at_openings(task) : aimed_at_angle(task);
    if (!aimed.failure.empty()) {
        return failed(std::move(aimed.failure));
    }
    LaidPass laid = laid_between_turns(task, aimed.wall, turns);
    if (!laid.failure.empty()) {
        return failed(std::move(laid.failure));
    }
    if (std::string why = add_ends(task, aimed.wall, laid.pass, turns); !why.empty()) {
        return failed(std::move(why));
    }
    ClosedCircuits circuits =
        closed_by_pattern(task, std::move(aimed.wall), std::move(laid.pass), turns);
    if (circuits.failure.empty()) {
        circuits.failure = why_not_enough(task, circuits.wall.path);
    }
    if (circuits.failure.empty()) {
        circuits.failure =
            turns.place(circuits.pattern, circuits.lattice ? circuits.lattice->series : 1);
    }
    return circuits;
}

}  // namespace meshwind
