// The dynamic programme of optimal_motion.h.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

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
constexpr int kMostLonger = 4;
constexpr int kMostShorter = 2;

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

class Grid {
public:
    explicit Grid(const MotionKnots& knots) : knots_(knots), axes_(knots.axis_count()) {
        for (std::size_t a = 0; a < axes_; ++a) {
            const Axis& axis = knots.axis(a);
            wraps_.push_back(axis.type == AxisType::Rotary);
            turns_or_moves_eye_.push_back(knots.moves_eye(a));
            velocity_.push_back(axis.velocity);
            acceleration_.push_back(axis.acceleration);
        }
    }

    // Empty where no way leads through.
    std::vector<KnotChoice> choose() {
        const std::size_t n = knots_.size();
        std::vector<std::vector<std::uint16_t>> from(n);
        Column before;
        Column now;
        Column after;
        fill(0, now, now);
        fill(1, now, after);
        std::vector<double> cost(kStates, kInfinity);
        for (std::size_t s = 0; s < kStates; ++s) {
            cost[s] = clear(0, s, now) ? 0.0 : kInfinity;
        }
        for (std::size_t k = 1; k < n; ++k) {
            std::swap(before, now);
            std::swap(now, after);
            if (k + 1 < n) {
                fill(k + 1, now, after);
            }
            const std::vector<double> next = advance(k, before, now, after, cost, from[k]);
            const double least = *std::min_element(next.begin(), next.end());
            if (least == kInfinity) {
                return {};
            }
            for (std::size_t s = 0; s < kStates; ++s) {
                cost[s] = s == kGiven || next[s] <= least + kBeam_s ? next[s] : kInfinity;
            }
        }
        return trace_back(cost, from);
    }

private:
    // The times at which the states of a knot are reached at best, and from which states.
    std::vector<double> advance(std::size_t k, const Column& before, const Column& now,
                                const Column& after, const std::vector<double>& cost,
                                std::vector<std::uint16_t>& from) const {
        from.assign(kStates, 0);
        std::vector<double> next(kStates, kInfinity);
        const bool last = k + 1 == knots_.size();
        const auto stay = [&](std::size_t s) {
            return last ? 0.0 : stay_s(k, s, before, now, after);
        };
        const double latest_s = latest(k, before, now, cost, stay);
        const std::size_t first = knots_[k].kept ? kGiven : 0;
        parallel_for(kStates - first, kChunk, [&](std::size_t begin, std::size_t end) {
            std::vector<Best> steps;
            for (std::size_t s = first + begin; s < first + end; ++s) {
                if (!in_reach(s, cost) || !clear(k, s, now)) {
                    continue;
                }
                const double stay_here_s = stay(s);
                const Best best =
                    best_before(k, s, before, now, cost,
                                s == kGiven ? kInfinity : latest_s - stay_here_s, steps);
                if (best.cost < kInfinity) {
                    from[s] = static_cast<std::uint16_t>(best.state);
                    next[s] = best.cost + stay_here_s;
                }
            }
        });
        return next;
    }

    // States that are reached later than this are given up: those that stay as they are, the given
    // one and the first of all, are reached by then.
    template <typename Stay>
    [[nodiscard]] double latest(std::size_t k, const Column& before, const Column& now,
                                const std::vector<double>& cost, const Stay& stay) const {
        const auto arrival = [&](std::size_t s) {
            return cost[s] + step_cost(k, s, s, before, now) + stay(s);
        };
        double least = cost[kGiven] < kInfinity ? arrival(kGiven) : kInfinity;
        const auto first =
            static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
        if (first != kGiven && !knots_[k].kept && arrival(first) < least && clear(k, first, now) &&
            passes(k, before.choice[first], now.choice[first])) {
            least = arrival(first);
        }
        return least + kBeam_s + kRounding_s;
    }

    [[nodiscard]] KnotChoice choice(std::size_t k, std::size_t s) const {
        if (s == kGiven) {
            return knots_[k].given;
        }
        const double length = knots_.task().fixed_lengths
                                  ? knots_[k].given.length_mm
                                  : knots_.least_mm(k) + length_of(s) * kLengthStep_mm;
        return {
            knots_.central_rad(k, length, knots_[k].given.turn_rad) + turn_of(s) * kTurnStep_rad,
            length};
    }

    [[nodiscard]] bool clear(std::size_t k, std::size_t s, const Column& column) const {
        const bool twice = knots_.task().fixed_lengths && length_of(s) > 0;
        return s == kGiven || (!knots_[k].kept && !twice && knots_.clear(k, column.choice[s]));
    }

    void fill(std::size_t k, const Column& before, Column& column) const {
        column.joints.resize(kStates * axes_);
        // What is kept has no other state, nor have its neighbours a use for theirs there.
        const bool kept = knots_[k].kept && (k == 0 || knots_[k - 1].kept) &&
                          (k + 1 == knots_.size() || knots_[k + 1].kept);
        const std::size_t least = kept ? kGiven : 0;
        parallel_for(kStates - least, kChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = least + begin; s < least + end; ++s) {
                column.choice[s] = choice(k, s);
                const std::span<double> row(column.joints.data() + s * axes_, axes_);
                const bool first = before.joints.empty() || k == 0;
                knots_.joints(
                    k, column.choice[s],
                    first ? knots_.start() : std::span(before.joints.data() + s * axes_, axes_),
                    row);
            }
        });
    }

    [[nodiscard]] double move(const Column& a, std::size_t from, const Column& b, std::size_t to,
                              std::size_t axis) const {
        const double d = b.joints[to * axes_ + axis] - a.joints[from * axes_ + axis];
        // Within half a turn the remainder is the difference itself.
        return wraps_[axis] && std::abs(d) >= kPi ? std::remainder(d, 2.0 * kPi) : d;
    }

    // How much longer the accelerations make a step, were the state to stay as it is.
    [[nodiscard]] double stay_s(std::size_t k, std::size_t s, const Column& before,
                                const Column& now, const Column& after) const {
        const double t1 = knots_.step_s(k - 1);
        const double t2 = knots_.step_s(k);
        double worst = 1.0;
        for (std::size_t a = 0; a < axes_; ++a) {
            const double v1 = move(before, s, now, s, a) / t1;
            const double v2 = move(now, s, after, s, a) / t2;
            worst = std::max({worst, std::abs(v2 - v1) / (0.5 * (t1 + t2) * acceleration_[a])});
        }
        return 0.5 * (t1 + t2) * (std::sqrt(worst) - 1.0);
    }

    struct Best {
        double cost = kInfinity;
        std::size_t state = 0;
        std::size_t order = 0;
    };

    [[nodiscard]] double step_cost(std::size_t k, std::size_t from, std::size_t to,
                                   const Column& before, const Column& now) const {
        const double ds = knots_[k - 1].ahead_mm;
        const double dl = now.choice[to].length_mm - before.choice[from].length_mm;
        if (dl < -kShorteningRate * ds - kRateSlack_mm ||
            dl > kLengtheningRate * ds + kRateSlack_mm) {
            return kInfinity;
        }
        const double t = knots_.step_s(k - 1);
        double ratio = std::max(1.0, 1.0 + dl / ds);
        for (std::size_t a = 0; a < axes_; ++a) {
            if (turns_or_moves_eye_[a]) {
                ratio =
                    std::max(ratio, std::abs(move(before, from, now, to, a)) / (t * velocity_[a]));
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

    // From a place to the next, whole turns apart.
    [[nodiscard]] bool passes(std::size_t k, const KnotChoice& from, const KnotChoice& to) const {
        KnotChoice near = to;
        near.turn_rad = from.turn_rad + std::remainder(to.turn_rad - from.turn_rad, 2.0 * kPi);
        return knots_.clear_between(k - 1, from, near);
    }

    // Whether a step is clear costs much more to know than how long it takes: the cheapest are
    // asked first, and the first that is clear is the best. None where that would be later than the
    // latest.
    [[nodiscard]] Best best_before(std::size_t k, std::size_t s, const Column& before,
                                   const Column& now, const std::vector<double>& cost,
                                   double latest, std::vector<Best>& steps) const {
        steps.clear();
        for_states_before(s, [&](std::size_t from) {
            if (cost[from] + knots_.step_s(k - 1) <= latest) {
                const double c = cost[from] + step_cost(k, from, s, before, now);
                if (c < kInfinity && c <= latest) {
                    steps.push_back({c, from, steps.size()});
                }
            }
        });
        for (auto first = steps.begin(); first != steps.end(); ++first) {
            // Of equals the one that was thought of first.
            std::iter_swap(first,
                           std::min_element(first, steps.end(), [](const Best& a, const Best& b) {
                               return a.cost < b.cost || (a.cost == b.cost && a.order < b.order);
                           }));
            const bool given = first->state == kGiven && s == kGiven;
            if (given || passes(k, before.choice[first->state], now.choice[s])) {
                return *first;
            }
        }
        return {};
    }

    // The states from which a step to this one is thought of.
    template <typename Visit>
    static void for_states_before(std::size_t s, const Visit& visit) {
        if (s == kGiven) {
            for (std::size_t from = 0; from < kStates; ++from) {
                visit(from);
            }
            return;
        }
        visit(kGiven);
        for (int turn = std::max(-kTurnsToASide, turn_of(s) - 1);
             turn <= std::min(kTurnsToASide, turn_of(s) + 1); ++turn) {
            for (int length = std::max(0, length_of(s) - kMostLonger);
                 length <= std::min(kLengths - 1, length_of(s) + kMostShorter); ++length) {
                visit(state_of(turn, length));
            }
        }
    }

    [[nodiscard]] static bool in_reach(std::size_t s, const std::vector<double>& cost) {
        bool any = false;
        for_states_before(s, [&](std::size_t from) { any = any || cost[from] < kInfinity; });
        return any;
    }

    [[nodiscard]] std::vector<KnotChoice> trace_back(
        const std::vector<double>& cost,
        const std::vector<std::vector<std::uint16_t>>& from) const {
        const std::size_t n = knots_.size();
        std::vector<KnotChoice> way(n);
        std::size_t s =
            static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
        for (std::size_t k = n; k-- > 0;) {
            way[k] = choice(k, s);
            s = k > 0 ? from[k][s] : 0;
        }
        // Turns were compared but for whole ones.
        for (std::size_t k = 1; k < n; ++k) {
            way[k].turn_rad = way[k - 1].turn_rad +
                              std::remainder(way[k].turn_rad - way[k - 1].turn_rad, 2.0 * kPi);
        }
        return way;
    }

    const MotionKnots& knots_;
    std::size_t axes_;
    std::vector<bool> wraps_;
    std::vector<bool> turns_or_moves_eye_;  // not the wrist, whose solution may change
    std::vector<double> velocity_;
    std::vector<double> acceleration_;
};

}  // namespace

std::vector<KnotChoice> choose_on_grid(const MotionKnots& knots) {
    return Grid(knots).choose();
}

}  // namespace meshwind
