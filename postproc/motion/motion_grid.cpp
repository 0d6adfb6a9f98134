// The dynamic programme of optimal_motion.h.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/units.h"
#include "postproc/motion/motion_knots.h"

namespace meshwind {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Turns, counted from the central angle.
constexpr double kTurnStep_rad = 12.0 / 180.0 * kPi;
constexpr int kTurnsToASide = 3;
constexpr int kTurns = 2 * kTurnsToASide + 1;

// Lengths: a step that fibre of one knot's distance can give back (kShorteningRate).
constexpr double kLengthStep_mm = kShorteningRate * kKnot_mm;
constexpr int kLengths = 36;

// Steps of a length that may be taken from one place to the next (kLengtheningRate).
constexpr int kMaxLonger = 4;
constexpr int kMaxShorter = 2;

// Rounding of lengths that change by just what they may.
constexpr double kRateSlack_mm = 1e-9;

// A change of column asks the axes for more than staying in it, which the programme does not see:
// it counts as so much of a step's time.
constexpr double kChangeOfTurn = 0.3;
constexpr double kChangeOfLength = 0.05;

constexpr std::size_t kChunk = 32;

// States that are so much later than the best one are given up.
constexpr double kBeam_s = 0.5;

// Far more than sums of times are rounded by.
constexpr double kRounding_s = 1e-9;

// States of a knot: a grid of turns and lengths, and the given motion.
constexpr std::size_t kGiven = std::size_t{kTurns} * kLengths;
constexpr std::size_t kStates = kGiven + 1;

int turn_of(std::size_t state) {
    return static_cast<int>(state) / kLengths - kTurnsToASide;
}
int length_of(std::size_t state) {
    return static_cast<int>(state) % kLengths;
}
std::size_t state_of(int turn, int length) {
    return static_cast<std::size_t>(turn + kTurnsToASide) * kLengths +
           static_cast<std::size_t>(length);
}

// All states of one knot.
struct Column {
    std::vector<KnotChoice> choice = std::vector<KnotChoice>(kStates);
    std::vector<double> joints;  // kStates x axes
};

// Of three neighbouring knots, the middle one being looked at.
struct Columns {
    Column before;
    Column now;
    Column after;
};

// The axes, as the programme asks for them.
struct GridAxes {
    std::size_t count = 0;
    std::vector<bool> wraps{};
    std::vector<bool> turns_or_moves_eye{};  // not the wrist, whose solution may change
    std::vector<double> velocity{};
    std::vector<double> acceleration{};
};

GridAxes grid_axes(const MotionKnots& knots) {
    GridAxes axes{.count = knots.axis_count()};
    for (std::size_t a = 0; a < axes.count; ++a) {
        const Axis& axis = knots.axis(a);
        axes.wraps.push_back(axis.type == AxisType::Rotary);
        axes.turns_or_moves_eye.push_back(knots.moves_eye(a));
        axes.velocity.push_back(axis.velocity);
        axes.acceleration.push_back(axis.acceleration);
    }
    return axes;
}

KnotChoice choice_of(const MotionKnots& knots, std::size_t k, std::size_t s) {
    if (s == kGiven) {
        return knots[k].given;
    }
    const double length = knots.task().fixed_lengths
                              ? knots[k].given.length_mm
                              : knots.least_mm(k) + length_of(s) * kLengthStep_mm;
    return {knots.central_rad(k, length, knots[k].given.turn_rad) + turn_of(s) * kTurnStep_rad,
            length};
}

bool is_clear(const MotionKnots& knots, std::size_t k, std::size_t s, const Column& column) {
    const bool twice = knots.task().fixed_lengths && length_of(s) > 0;
    return s == kGiven || (!knots[k].kept && !twice && knots.clear(k, column.choice[s]));
}

void fill(const MotionKnots& knots, std::size_t k, const Column& before, Column& column) {
    const std::size_t axes = knots.axis_count();
    column.joints.resize(kStates * axes);
    // What is kept has no other state, nor have its neighbours a use for theirs there.
    const bool kept = knots[k].kept && (k == 0 || knots[k - 1].kept) &&
                      (k + 1 == knots.size() || knots[k + 1].kept);
    const std::size_t least = kept ? kGiven : 0;
    parallel_for(kStates - least, kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = least + begin; s < least + end; ++s) {
            column.choice[s] = choice_of(knots, k, s);
            const std::span<double> row(column.joints.data() + s * axes, axes);
            const bool first = before.joints.empty() || k == 0;
            knots.joints(k, column.choice[s],
                         first ? knots.start() : std::span(before.joints.data() + s * axes, axes),
                         row);
        }
    });
}

// What steps cost to a knot from the one before.
class StepCosts {
public:
    StepCosts(const MotionKnots& knots, const GridAxes& axes, std::size_t k, const Columns& columns)
        : knots_(knots),
          axes_(axes),
          k_(k),
          before_(columns.before),
          now_(columns.now),
          after_(columns.after) {}

    // The time of a step, with what a change of column counts; infinite where lengths change too
    // fast.
    [[nodiscard]] double step_s(std::size_t from, std::size_t to) const;

    // How much longer the accelerations make a step, were the state to stay as it is.
    [[nodiscard]] double stay_s(std::size_t s) const;

    // The time of a step is no less.
    [[nodiscard]] double least_s() const { return knots_.step_s(k_ - 1); }

    // From a place to the next, whole turns apart.
    [[nodiscard]] bool passes(std::size_t from, std::size_t to) const;

    [[nodiscard]] bool is_clear(std::size_t s) const {
        return meshwind::is_clear(knots_, k_, s, now_);
    }
    [[nodiscard]] bool kept() const { return knots_[k_].kept; }

private:
    [[nodiscard]] double move(const Column& a, std::size_t from, const Column& b, std::size_t to,
                              std::size_t axis) const {
        const double d = b.joints[to * axes_.count + axis] - a.joints[from * axes_.count + axis];
        // Within half a turn the remainder is the difference itself.
        return axes_.wraps[axis] && std::abs(d) >= kPi ? std::remainder(d, 2.0 * kPi) : d;
    }

    const MotionKnots& knots_;
    const GridAxes& axes_;
    std::size_t k_;
    const Column& before_;
    const Column& now_;
    const Column& after_;
};

double StepCosts::step_s(std::size_t from, std::size_t to) const {
    const double ds = knots_[k_ - 1].ahead_mm;
    const double dl = now_.choice[to].length_mm - before_.choice[from].length_mm;
    if (dl < -kShorteningRate * ds - kRateSlack_mm || dl > kLengtheningRate * ds + kRateSlack_mm) {
        return kInfinity;
    }
    const double t = knots_.step_s(k_ - 1);
    double ratio = std::max(1.0, 1.0 + dl / ds);
    for (std::size_t a = 0; a < axes_.count; ++a) {
        if (axes_.turns_or_moves_eye[a]) {
            ratio = std::max(ratio,
                             std::abs(move(before_, from, now_, to, a)) / (t * axes_.velocity[a]));
        }
    }
    if (from != kGiven && to != kGiven) {
        ratio += kChangeOfTurn * std::abs(turn_of(to) - turn_of(from)) +
                 kChangeOfLength * std::abs(length_of(to) - length_of(from));
    } else if (from != to) {
        ratio += kChangeOfTurn;
    }
    return t * ratio;
}

double StepCosts::stay_s(std::size_t s) const {
    if (k_ + 1 == knots_.size()) {
        return 0.0;
    }
    const double t1 = knots_.step_s(k_ - 1);
    const double t2 = knots_.step_s(k_);
    double worst = 1.0;
    for (std::size_t a = 0; a < axes_.count; ++a) {
        const double v1 = move(before_, s, now_, s, a) / t1;
        const double v2 = move(now_, s, after_, s, a) / t2;
        worst = std::max({worst, std::abs(v2 - v1) / (0.5 * (t1 + t2) * axes_.acceleration[a])});
    }
    return 0.5 * (t1 + t2) * (std::sqrt(worst) - 1.0);
}

bool StepCosts::passes(std::size_t from, std::size_t to) const {
    const KnotChoice& start = before_.choice[from];
    KnotChoice near = now_.choice[to];
    near.turn_rad = start.turn_rad + std::remainder(near.turn_rad - start.turn_rad, 2.0 * kPi);
    return knots_.clear_between(k_ - 1, start, near);
}

// The states from which a step to this one is thought of.
template <typename Visit>
void for_states_before(std::size_t s, const Visit& visit) {
    if (s == kGiven) {
        for (std::size_t from = 0; from < kStates; ++from) {
            visit(from);
        }
        return;
    }
    visit(kGiven);
    for (int turn = std::max(-kTurnsToASide, turn_of(s) - 1);
         turn <= std::min(kTurnsToASide, turn_of(s) + 1); ++turn) {
        for (int length = std::max(0, length_of(s) - kMaxLonger);
             length <= std::min(kLengths - 1, length_of(s) + kMaxShorter); ++length) {
            visit(state_of(turn, length));
        }
    }
}

bool in_reach(std::size_t s, const std::vector<double>& cost_s) {
    bool any = false;
    for_states_before(s, [&](std::size_t from) { any = any || cost_s[from] < kInfinity; });
    return any;
}

// States that are reached later than this are given up: those that stay as they are, the given
// one and the first of all, are reached by then.
double latest_s(const StepCosts& costs, const std::vector<double>& cost_s) {
    const auto arrival = [&](std::size_t s) {
        return cost_s[s] + costs.step_s(s, s) + costs.stay_s(s);
    };
    double least = cost_s[kGiven] < kInfinity ? arrival(kGiven) : kInfinity;
    const auto first =
        static_cast<std::size_t>(std::min_element(cost_s.begin(), cost_s.end()) - cost_s.begin());
    if (first != kGiven && !costs.kept() && arrival(first) < least && costs.is_clear(first) &&
        costs.passes(first, first)) {
        least = arrival(first);
    }
    return least + kBeam_s + kRounding_s;
}

// A state reached from one before.
struct Arrival {
    double cost_s = kInfinity;
    std::size_t state = 0;
    std::size_t order = 0;
};

// Whether a step is clear costs much more to know than how long it takes: the cheapest are
// asked first, and the first that is clear is the best. None where that would be later than the
// latest.
// \param steps room for those that are thought of
Arrival best_arrival(const StepCosts& costs, std::size_t s, const std::vector<double>& cost_s,
                     double latest, std::vector<Arrival>& steps) {
    steps.clear();
    for_states_before(s, [&](std::size_t from) {
        if (cost_s[from] + costs.least_s() <= latest) {
            const double c = cost_s[from] + costs.step_s(from, s);
            if (c < kInfinity && c <= latest) {
                steps.push_back({c, from, steps.size()});
            }
        }
    });
    for (auto first = steps.begin(); first != steps.end(); ++first) {
        // Of equals the one that was thought of first.
        std::iter_swap(
            first, std::min_element(first, steps.end(), [](const Arrival& a, const Arrival& b) {
                return a.cost_s < b.cost_s || (a.cost_s == b.cost_s && a.order < b.order);
            }));
        const bool given = first->state == kGiven && s == kGiven;
        if (given || costs.passes(first->state, s)) {
            return *first;
        }
    }
    return {};
}

// Per state of a knot.
struct Advance {
    std::vector<double> cost_s = std::vector<double>(kStates, kInfinity);  // at best
    std::vector<std::uint16_t> from = std::vector<std::uint16_t>(kStates, 0);
};

// The times at which the states of a knot are reached at best, and from which states.
Advance advance(const StepCosts& costs, const std::vector<double>& cost_s) {
    Advance next;
    const double latest = latest_s(costs, cost_s);
    const std::size_t first = costs.kept() ? kGiven : 0;
    parallel_for(kStates - first, kChunk, [&](std::size_t begin, std::size_t end) {
        std::vector<Arrival> steps;
        for (std::size_t s = first + begin; s < first + end; ++s) {
            if (!in_reach(s, cost_s) || !costs.is_clear(s)) {
                continue;
            }
            const double stay_here_s = costs.stay_s(s);
            const Arrival best = best_arrival(
                costs, s, cost_s, s == kGiven ? kInfinity : latest - stay_here_s, steps);
            if (best.cost_s < kInfinity) {
                next.from[s] = static_cast<std::uint16_t>(best.state);
                next.cost_s[s] = best.cost_s + stay_here_s;
            }
        }
    });
    return next;
}

// The choices that lead to the state that is reached first.
// \param from per knot, of each state
std::vector<KnotChoice> trace_back(const MotionKnots& knots, const std::vector<double>& cost_s,
                                   const std::vector<std::vector<std::uint16_t>>& from) {
    const std::size_t n = knots.size();
    std::vector<KnotChoice> way(n);
    std::size_t s =
        static_cast<std::size_t>(std::min_element(cost_s.begin(), cost_s.end()) - cost_s.begin());
    for (std::size_t k = n; k-- > 0;) {
        way[k] = choice_of(knots, k, s);
        s = k > 0 ? from[k][s] : 0;
    }
    // Turns were compared but for whole ones.
    for (std::size_t k = 1; k < n; ++k) {
        way[k].turn_rad =
            way[k - 1].turn_rad + std::remainder(way[k].turn_rad - way[k - 1].turn_rad, 2.0 * kPi);
    }
    return way;
}

}  // namespace

// Empty where no way leads through.
std::vector<KnotChoice> choose_on_grid(const MotionKnots& knots) {
    const std::size_t n = knots.size();
    const GridAxes axes = grid_axes(knots);
    std::vector<std::vector<std::uint16_t>> from(n);
    Columns columns;
    fill(knots, 0, columns.now, columns.now);
    fill(knots, 1, columns.now, columns.after);
    std::vector<double> cost_s(kStates, kInfinity);
    for (std::size_t s = 0; s < kStates; ++s) {
        cost_s[s] = is_clear(knots, 0, s, columns.now) ? 0.0 : kInfinity;
    }
    for (std::size_t k = 1; k < n; ++k) {
        std::swap(columns.before, columns.now);
        std::swap(columns.now, columns.after);
        if (k + 1 < n) {
            fill(knots, k + 1, columns.now, columns.after);
        }
        Advance next = advance(StepCosts(knots, axes, k, columns), cost_s);
        from[k] = std::move(next.from);
        const double least = *std::min_element(next.cost_s.begin(), next.cost_s.end());
        if (least == kInfinity) {
            return {};
        }
        for (std::size_t s = 0; s < kStates; ++s) {
            cost_s[s] =
                s == kGiven || next.cost_s[s] <= least + kBeam_s ? next.cost_s[s] : kInfinity;
        }
    }
    return trace_back(knots, cost_s, from);
}

}  // namespace meshwind
