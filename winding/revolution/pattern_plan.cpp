#include "winding/revolution/pattern_plan.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/margins.h"
#include "core/parallel.h"
#include "core/secant_root.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "winding/laminate/measure_plan.h"
#include "winding/revolution/aim_pass.h"
#include "winding/revolution/hollow_rim.h"
#include "winding/revolution/hoop_path.h"
#include "winding/revolution/regular_parts.h"
#include "winding/revolution/revolution_pieces.h"
#include "winding/revolution/steered_pass.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// A pass that meets no end within this circles for ever.
constexpr double kLongest_mm = 1e5;

// A closed pattern may change the winding angle by so much.
constexpr double kMostAngle_rad = rad_from_deg(3.0);

constexpr double kSlope_rad = 1e-4;

// Patterns whose bands, at the angle that closes them, leave gaps are looked for again so often. No
// tow keeps its width to this share: what another angle changes is more.
constexpr int kMostTries = 6;
constexpr double kNoGap = 1e-3;

// Closure in rad: far below what any axis resolves.
constexpr double kClosed_rad = 1e-12;

// A fibre that ends behind a hollow rim is laid on the extension for so many tow widths: it then
// ends where it lies on something, whatever the blocks are off.
constexpr double kRunOutTows = 1.0;

// Turns at given radii at both ends are met to 1e-6 mm; with that a secant comes so near to the
// turn of a circuit, and the slip stays as it is for what is left.
constexpr double kNearlyClosed_rad = 1e-6;

class PatternPlanner {
public:
    PatternPlanner(const Mandrel& mandrel, const BodyOfRevolution& body,
                   const PatternOptions& options)
        : mandrel_(mandrel),
          body_(body),
          meridian_(body.meridian),
          options_(options),
          rule_{options.tow.friction, options.turn.extension_mm, options.tow.width_mm},
          pieces_(mandrel, body, rule_),
          turns_(options.turns(options.tow, options.turn.extension_mm)) {
        plan_.planner = Planner::Pattern;
        widest_mm_ = meridian_.widest_mm();
        widest_radius_mm_ = meridian_.at(widest_mm_).radius_mm;
        angle_rad_ = options.angle_rad;
    }

    Plan run() {
        if (options_.kind == PatternKind::Hoop) {
            lay_hoops();
            return std::move(plan_);
        }
        const bool aimed = options_.kind == PatternKind::Polar ? aim_at_openings() : aim_at_angle();
        if (!aimed || !lift_over_rims() || !ends_hold() || !choose_pattern() || !can_cover() ||
            !place_turns()) {
            return std::move(plan_);
        }
        begin_at({goal(0), goal(1)}, {laid_.stations.front(), way_back(laid_).front()});
        if (!winds_circuits()) {
            return std::move(plan_);
        }
        lay();
        // At a turn of its own the band is whole as far as its middle.
        measure(pass_.stations.front().arc_mm, pass_.stations.back().arc_mm);
        return std::move(plan_);
    }

private:
    bool fail(const std::string& words) {
        plan_.failure = words;
        return false;
    }

    [[nodiscard]] MeridianPass pass(double angle_rad) const {
        return pass_through(meridian_, widest_mm_, angle_rad, slip_, pieces_.station_mm(),
                            kLongest_mm);
    }

    // Where the band touches the opening of an end, or the pole.
    [[nodiscard]] double touching_mm(std::size_t end) const {
        const Rim* const rim = pieces_.rim_of(end);
        return (rim != nullptr ? rim->radius_mm : 0.0) + 0.5 * options_.tow.width_mm;
    }

    // Helical: the steering with which a pass at the angle asked for comes to both ends.
    bool aim_at_angle() {
        const PassAim aim =
            aim_at_ends(body_, {.angle_rad = angle_rad_,
                                .most_slip = options_.tow.friction.share(margin::kPatternSteering),
                                .touching_mm = {touching_mm(0), touching_mm(1)}});
        slip_ = aim.slip;
        pass_ = pass(angle_rad_);
        return aim.failure.empty() || fail(aim.failure);
    }

    // Polar: winding angle and steering with which the band touches the openings of both ends.
    bool aim_at_openings() {
        for (std::size_t end = 0; end < 2; ++end) {
            const double turn_mm = touching_mm(end);
            if (turn_mm >= widest_radius_mm_) {
                return fail("a polar winding turns round the openings, and the " +
                            std::string(end == 0 ? "lower" : "upper") +
                            " end has none that is smaller than the body: radius " +
                            fixed(turn_mm, 1) + " of " + fixed(widest_radius_mm_, 1) +
                            " mm; use \"helical\"");
            }
        }
        const SteeringFinding steering = between_openings(0.0);
        if (!steering.found) {
            return fail("the openings are too different: with the friction of " +
                        fixed(options_.tow.friction.share(margin::kPatternSteering), 3) +
                        " a band that touches the lower one turns at radius " +
                        fixed(steering.reached_mm, 1) + " mm at the upper end, where " +
                        fixed(touching_mm(1), 1) + " mm would touch it");
        }
        take(*steering.found);
        return true;
    }

    // From one opening to the other, each turned at farther off by so much.
    [[nodiscard]] SteeringFinding between_openings(double off_mm) const {
        return steer_between(meridian_,
                             {.lower_mm = touching_mm(0) + off_mm,
                              .upper_mm = touching_mm(1) + off_mm,
                              .most_slip = options_.tow.friction.share(margin::kPatternSteering),
                              .station_mm = pieces_.station_mm(),
                              .longest_mm = kLongest_mm});
    }

    void take(const SteeredPass& steered) {
        slip_ = {steered.slip_ratio, steered.slip_ratio};
        angle_rad_ = steered.angle_rad;
        pass_ = steered.pass;
    }

    // The pass with ends that go straight over hollow rims, unless its turns leave them on the
    // wall.
    bool lift_over_rims() {
        LaidPass lifted;
        lifted.pass = pass_;
        if (turns_->lifts_over_hollow_rims()) {
            lifted = lifted_over_rims(meridian_, pass_,
                                      {.angle_rad = angle_rad_,
                                       .most_gap_mm = options_.tow.bridging_tolerance_mm,
                                       .station_mm = pieces_.station_mm()});
        }
        laid_ = std::move(lifted.pass);
        return lifted.failure.empty() || fail(lifted.failure);
    }

    // Whether both ends of the pass can be turned at.
    bool ends_hold() {
        for (std::size_t end = 0; end < 2; ++end) {
            const MeridianStop stop = end == 0 ? pass_.lower : pass_.upper;
            const std::string name = end == 0 ? "lower" : "upper";
            if (stop == MeridianStop::Length) {
                return fail("a fibre at " + degrees(angle_rad_) + " never reaches the body's " +
                            name + " end");
            }
            if (stop == MeridianStop::Hoop) {
                continue;
            }
            const Rim* const rim = pieces_.rim_of(end);
            if (rim == nullptr) {
                return fail("a fibre at " + degrees(angle_rad_) + " runs over the " + name +
                            " pole; a larger angle turns before it");
            }
            const MeridianStation& at = end == 0 ? laid_.stations.front() : laid_.stations.back();
            const std::string why =
                turns_->add({end, *rim, pieces_.crossing_of(end, at, 0.0), angle_rad_});
            if (!why.empty()) {
                return fail(why);
            }
        }
        const std::string why =
            dwells(0) || dwells(1) ? std::string() : turns_->why_no_ends(angle_rad_);
        return why.empty() || fail(why);
    }

    // For the pattern that was chosen.
    bool place_turns() {
        const std::string why = turns_->place(pattern_, lattice_ ? lattice_->series : 1);
        return why.empty() || fail(why);
    }

    [[nodiscard]] bool dwells(std::size_t end) const {
        return (end == 0 ? pass_.lower : pass_.upper) == MeridianStop::End;
    }

    // Turn of the mandrel in a circuit without dwell.
    [[nodiscard]] double circuit_rad() const {
        double turn = 2.0 * laid_.turn_rad();
        for (std::size_t end = 0; end < 2; ++end) {
            turn += dwells(end) ? turns_->shortest_rad(end) : 0.0;
        }
        return turn;
    }

    // r cos(angle) where bands lie farthest apart: without steering at the widest place.
    [[nodiscard]] double sparsest_mm() const {
        double sparsest = widest_radius_mm_ * std::cos(angle_rad_);
        for (const MeridianStation& at : pass_.stations) {
            sparsest = std::max(sparsest, at.place.radius_mm * std::cos(at.angle_rad));
        }
        return sparsest;
    }

    bool choose_pattern() {
        const bool dwell = dwells(0) || dwells(1);
        CircuitToClose circuit;
        circuit.turn_rad = circuit_rad();
        circuit.most_change_rad = dwell ? 0.0 : most_change_rad();
        circuit.dwelling_ends = static_cast<int>(dwells(0)) + static_cast<int>(dwells(1));
        circuit.band_mm = options_.tow.width_mm;
        circuit.mm_per_rad = sparsest_mm();
        circuit.layers =
            options_.lattice ? 1 : std::max(1, static_cast<int>(std::lround(options_.layers)));
        if (!(dwell ? find_pattern(circuit) : find_and_close(circuit))) {
            return false;
        }
        if (options_.lattice) {
            lattice_ = laid_lattice(pattern_, circuit, *options_.lattice, options_.wish);
            if (lattice_->series > 1 && !dwell) {
                return fail(
                    "the bands of a rib are set side by side by dwelling at a rim, and the "
                    "fibre turns by itself at both ends; ask for one series");
            }
        }
        return true;
    }

    bool find_pattern(const CircuitToClose& circuit) {
        FoundPattern found;
        try {
            const auto find = [&](const PatternWish& wish) {
                return options_.lattice ? find_wished_lattice(circuit, *options_.lattice, wish)
                                        : find_wished_pattern(circuit, wish);
            };
            found = turns_->find(options_.wish, find);
        } catch (const InputError& error) {
            return fail(std::string("no pattern can be looked for: ") + error.what());
        }
        if (!found.pattern) {
            return fail(found.failure);
        }
        pattern_ = *found.pattern;
        return true;
    }

    // Between bands, as they are to lie.
    [[nodiscard]] double offset_mm() const {
        return options_.wish.band_offset_mm > 0.0 ? options_.wish.band_offset_mm
                                                  : options_.tow.width_mm;
    }

    // Circuits that turn back by themselves close by another angle, at which bands may lie farther
    // apart: a pattern is then looked for that closes the wall with these. Where none is found the
    // first stands, with its gaps.
    bool find_and_close(CircuitToClose& circuit) {
        auto state = std::tie(pattern_, angle_rad_, slip_, pass_);
        const std::tuple asked(pattern_, angle_rad_, slip_, pass_);
        auto first = asked;
        bool closed = false;
        for (int tries = 1; !closed && tries <= kMostTries; ++tries) {
            state = asked;
            if (!find_pattern(circuit) || !close_by_angle(pattern_.turn_rad)) {
                if (tries == 1) {
                    return false;
                }
                plan_.failure.clear();
                break;
            }
            circuit.mm_per_rad = sparsest_mm();
            const double around_mm = 2.0 * kPi * circuit.mm_per_rad * circuit.layers;
            closed =
                options_.lattice || options_.wish.circuits > 0 ||
                static_cast<double>(pattern_.circuits) * offset_mm() >= (1.0 - kNoGap) * around_mm;
            if (tries == 1) {
                first = state;
            }
        }
        if (!closed) {
            state = first;
        }
        circuit.mm_per_rad = sparsest_mm();
        laid_ = pass_;
        pattern_ = with_bands_of(circuit, pattern_);
        return true;
    }

    // How much the turn of a circuit changes within kMostAngle_rad, by its slope.
    [[nodiscard]] double most_change_rad() const {
        const double more = pass(angle_rad_ + kSlope_rad).turn_rad();
        const double less = pass(angle_rad_ - kSlope_rad).turn_rad();
        return std::min(kPi, 2.0 * std::abs(more - less) / (2.0 * kSlope_rad) * kMostAngle_rad);
    }

    // The winding angle whose circuits turn the mandrel by just so much. Where a polar winding is
    // steered, both turns give way by the same length first, and the slip with them.
    bool close_by_angle(double turn_rad) {
        const auto not_closed = [&, wanted = angle_rad_] {
            return fail("no winding angle within " + degrees(kMostAngle_rad) + " of " +
                        degrees(wanted) + " closes a pattern of " +
                        std::to_string(pattern_.circuits) +
                        " circuits; another angle or tow width would");
        };
        if (options_.kind == PatternKind::Polar && slip_.above != 0.0) {
            const double most_mm = kMostAngle_rad * widest_radius_mm_ * std::cos(angle_rad_);
            const auto by_turns = [&](double off_mm) {
                const SteeringFinding steering = between_openings(off_mm);
                if (steering.found) {
                    take(*steering.found);
                }
                return 2.0 * pass_.turn_rad() - turn_rad;
            };
            if (!secant_root(by_turns, kSlope_rad * widest_radius_mm_, most_mm,
                             kNearlyClosed_rad)) {
                return not_closed();
            }
        }
        const double wanted = angle_rad_;
        const auto by_angle = [&](double off_rad) {
            angle_rad_ = wanted + off_rad;
            pass_ = pass(angle_rad_);
            return 2.0 * pass_.turn_rad() - turn_rad;
        };
        const bool closed = secant_root(by_angle, kSlope_rad, kMostAngle_rad, 1e3 * kClosed_rad);
        const bool turns = pass_.lower == MeridianStop::Hoop && pass_.upper == MeridianStop::Hoop;
        return (closed && turns) || not_closed();
    }

    // Where the band turns it counts as far as its middle.
    [[nodiscard]] bool can_cover() {
        const double share =
            share_between(meridian_, {pass_.stations.front().arc_mm, pass_.stations.back().arc_mm});
        return share >= options_.least_covered || fail("a pattern that turns back there covers " +
                                                       percent(share, 1) + " of the wall at most");
    }

    // Where the pattern may begin at an end.
    [[nodiscard]] ConnectingGoal goal(std::size_t end) const {
        if (dwells(end)) {
            return {ConnectingGoal::Kind::Rim, 0.0};
        }
        const MeridianStation& at = end == 0 ? pass_.stations.front() : pass_.stations.back();
        return {ConnectingGoal::Kind::Parallel, at.arc_mm};
    }

    // Leads on from the fibre of the layer before, where there is one and it can be, to where the
    // pattern begins then.
    void begin_at(const std::array<ConnectingGoal, 2>& goals,
                  const std::array<MeridianStation, 2>& first) {
        if (!options_.before) {
            return;
        }
        PatternBegin begin = begin_after(*options_.before, meridian_, pieces_, goals, first, rule_);
        plan_.cut_because = begin.cut_because;
        plan_.goes_on = plan_.cut_because.empty();
        if (!plan_.goes_on) {
            return;
        }
        for (LaidTurn& laid : begin.pieces) {
            add(std::move(laid));
        }
        begin_ = std::move(begin);
    }

    // The whole pattern.
    void lay() {
        const std::vector<double> starts = circuit_starts_rad(pattern_, lattice_);
        const std::size_t first = plan_.pieces.size();
        const std::size_t last = lay_circuits(starts);
        plan_.pins = turns_->pins();
        plan_.pieces.front().starts_fibre = true;
        plan_.fibres = 1;
        const std::array<double, 2> turn = turns_at_ends();
        const std::size_t start = begin_.end;
        LaidPattern& laid = plan_.details.emplace<LaidPattern>();
        laid.pattern = pattern_;
        laid.angle_rad = angle_rad_;
        laid.slip_ratio = std::abs(slip_.below) > std::abs(slip_.above) ? slip_.below : slip_.above;
        laid.closure_rad =
            closure_rad(plan_.pieces[first], plan_.pieces[last], turn[start], starts);
        laid.band_offset_mm = pattern_.step_rad * sparsest_mm();
        laid.interlacing = interlacing_of(pattern_, laid_.turn_rad(), turn[1 - start]);
        laid.starts_rad = starts;
        laid.lattice = lattice_;
    }

    // Whether the machine winds the first circuits, unless their pins are yet to be put on.
    bool winds_circuits() {
        constexpr std::size_t kCircuits = 3;
        if (!options_.winds || !turns_->pins().empty()) {
            return true;
        }
        const Plan before = plan_;
        std::vector<double> starts = circuit_starts_rad(pattern_, lattice_);
        starts.resize(std::min(kCircuits, starts.size()));
        lay_circuits(starts);
        const Rejection why = options_.winds(std::span(plan_.pieces).subspan(before.pieces.size()));
        plan_ = before;
        return why == Rejection::None ||
               fail("a circuit at " + degrees(angle_rad_, 1) + " cannot be wound: " + name_of(why));
    }

    // Adds the circuits that begin there. Returns which piece is the last pass.
    std::size_t lay_circuits(const std::vector<double>& starts) {
        const std::array<double, 2> turn = turns_at_ends();
        const std::size_t start = begin_.end;
        const std::array<std::vector<MeridianStation>, 2> ways{laid_.stations, way_back(laid_)};
        std::vector<Piece> passes(2 * starts.size());
        std::vector<double> turned(passes.size());  // of each against its way
        for (std::size_t i = 0; i < starts.size(); ++i) {
            const double begins = begin_.azimuth_rad + starts[i];
            double returns = begins + laid_.turn_rad() + turn[1 - start];
            if (!dwells(start) && i + 1 < starts.size()) {
                // What the next circuit is off its place is made up at the other end.
                returns += starts[i + 1] - starts[i] - pattern_.turn_rad;
            }
            turned[2 * i] = begins - ways[start].front().azimuth_rad;
            turned[2 * i + 1] = returns - ways[1 - start].front().azimuth_rad;
        }
        const bool fresh = plan_.pieces.empty();
        parallel_for(passes.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t from = i % 2 == 0 ? start : 1 - start;
                passes[i] = pieces_.course(
                    fresh && i == 0 && in_air(laid_, start)
                        ? tied_on_way(meridian_, pass_, laid_, from, pieces_.station_mm())
                        : ways[from],
                    turned[i]);
                passes[i].start_rim = rim_at(from);
                passes[i].end_rim = rim_at(1 - from);
            }
        });
        plan_.turns.resize(mandrel_.rims.size());
        for (std::size_t i = 0; i < passes.size(); ++i) {
            const std::size_t end = i % 2 == 0 ? 1 - start : start;
            add(std::move(passes[i]));
            if (dwells(end) && i + 1 < passes.size()) {
                add(turns_->turn(end, pieces_.crossing_of(end, ways[1 - end].back(), turned[i]),
                                 pieces_.crossing_of(end, ways[end].front(), turned[i + 1])));
            }
        }
        const std::size_t last = plan_.pieces.size() - 1;
        if (in_air(laid_, start)) {
            add(pieces_.run_out(start,
                                pieces_.crossing_of(start, ways[1 - start].back(), turned.back()),
                                kRunOutTows * options_.tow.width_mm));
        }
        plan_.courses = static_cast<int>(passes.size());
        return last;
    }

    // From where the fibre ends, turned on over its last rim, to where its pattern began.
    // \param first, last courses of the pattern
    [[nodiscard]] double closure_rad(const Piece& first, const Piece& last, double last_turn_rad,
                                     const std::vector<double>& starts_rad) const {
        const auto azimuth = [](const PathPoint& point) {
            return std::atan2(point.position_mm.y(), point.position_mm.x());
        };
        const double moved_rad =
            starts_rad[starts_rad.size() - static_cast<std::size_t>(pattern_.circuits)];
        const double end = azimuth(last.path.back()) + last_turn_rad - moved_rad;
        const bool tied_on = first.string.gap_mm.front() <= 0.0;
        const double begin = azimuth(first.path.front()) -
                             (tied_on ? tied_on_beside_rad(pass_, laid_, begin_.end) : 0.0);
        return std::abs(std::remainder(end - begin, 2.0 * kPi));
    }

    [[nodiscard]] std::int32_t rim_at(std::size_t end) const {
        return dwells(end) ? body_.end[end].rim : -1;
    }

    // Of the mandrel, over each end; dwell is shared by the rims.
    [[nodiscard]] std::array<double, 2> turns_at_ends() const {
        const double share = dwells(0) && dwells(1) ? 0.5 : 1.0;
        std::array<double, 2> turn{};
        for (std::size_t end = 0; end < 2; ++end) {
            if (dwells(end)) {
                turn[end] = turns_->shortest_rad(end) +
                            std::max(turns_->least_dwell_rad(), share * pattern_.dwell_rad);
            }
        }
        return turn;
    }

    void add(LaidTurn laid) {
        if (laid.rim >= 0) {
            plan_.turns.resize(mandrel_.rims.size());
            add_turn(std::move(laid), plan_);
        } else {
            add(std::move(laid.piece));
        }
    }

    void add(Piece piece) { add_piece(std::move(piece), plan_); }

    void lay_hoops() {
        const CylinderPart asked_for =
            options_.hoop_z_mm
                ? cylinder_between(meridian_, (*options_.hoop_z_mm)[0], (*options_.hoop_z_mm)[1])
                : cylinder_at(meridian_, widest_mm_);
        const double steering = options_.tow.friction.share(margin::kHoopSteering);
        const CylinderPart part = level_part(meridian_, asked_for, options_.tow.width_mm,
                                             options_.tow.friction.holds() - steering);
        if (part.to_mm == part.from_mm) {
            fail("hoops hold on a cylinder, and at its widest place, z " +
                 fixed(meridian_.at(widest_mm_).z_mm, 1) + " mm, the body is none");
            return;
        }
        const auto ply = [&](bool downward) {
            return hoop_ply(meridian_, part, options_.tow.width_mm, steering, pieces_.station_mm(),
                            downward);
        };
        const std::array first{ply(false).front(), ply(true).front()};
        begin_at({ConnectingGoal{ConnectingGoal::Kind::Parallel, first[0].arc_mm},
                  ConnectingGoal{ConnectingGoal::Kind::Parallel, first[1].arc_mm}},
                 first);
        const int plies = std::max(1, static_cast<int>(std::lround(options_.layers)));
        double begin_rad = begin_.azimuth_rad;
        bool downward = begin_.end == 1;
        for (int i = 0; i < plies; ++i, downward = !downward) {
            const std::vector<MeridianStation> stations = ply(downward);
            add(pieces_.course(stations, begin_rad));
            begin_rad += stations.back().azimuth_rad;
        }
        plan_.pieces.front().starts_fibre = true;
        plan_.courses = plies;
        plan_.fibres = 1;
        plan_.turns.resize(mandrel_.rims.size());
        measure(part.from_mm, part.to_mm);
    }

    // \param low_mm, high_mm arc lengths between which there shall be fibre
    void measure(double low_mm, double high_mm) {
        const auto between = [this](double from_mm, double to_mm) -> PlanZones::Zone {
            return [=, this](const Vector3d& position) {
                const double at =
                    meridian_.foot(std::hypot(position.x(), position.y()), position.z()).arc_mm;
                return at >= from_mm && at <= to_mm;
            };
        };
        PlanZones zones{between(low_mm, high_mm), {}, {}};
        regular_parts(body_, pass_, {low_mm, high_mm}, options_.tow.width_mm, zones);
        measure_plan(mandrel_.surface, mandrel_.surface, options_.tow.width_mm,
                     options_.context.seed, zones, plan_);
    }

    const Mandrel& mandrel_;
    const BodyOfRevolution& body_;
    const Meridian& meridian_;
    const PatternOptions& options_;
    TurnRule rule_;
    RevolutionPieces pieces_;
    std::unique_ptr<RimTurns> turns_;
    double widest_mm_ = 0.0;
    double widest_radius_mm_ = 0.0;
    double angle_rad_ = 0.0;  // at the widest place
    HalfSlips slip_;          // of the passes
    MeridianPass pass_;       // on the wall
    MeridianPass laid_;       // as fibre lies between two turns: straight over hollow rims
    Pattern pattern_;
    PatternBegin begin_;  // where the first circuit or ply begins
    std::optional<LaidLattice> lattice_;
    Plan plan_;
};

}  // namespace

Plan plan_pattern(const Mandrel& mandrel, const BodyOfRevolution& body,
                  const PatternOptions& options) {
    return PatternPlanner(mandrel, body, options).run();
}

}  // namespace meshwind
