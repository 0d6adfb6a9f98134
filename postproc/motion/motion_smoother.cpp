// The smoothing of optimal_motion.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/units.h"
#include "postproc/motion/motion_knots.h"

namespace meshwind {
namespace {

constexpr std::size_t kChunk = 128;

// Rounds of the method; after some ten of them little changes any more.
constexpr int kRounds = 16;

// Levenberg's damping, in seconds of a step per variable's unit squared, and how it changes.
constexpr double kFirstDamping = 1e-3;
constexpr double kLessDamping = 0.5;
constexpr double kMoreDamping = 6.0;

// Variables are counted in these.
constexpr double kTurnUnit_rad = 0.1;
constexpr double kLengthUnit_mm = 10.0;

// Ratios of an acceleration or velocity to its limit below these cost no time.
constexpr double kFreeAcceleration = 0.9;
constexpr double kFreeVelocity = 0.95;
// They weigh a little all the same, so that a motion without need is none; beyond, a velocity
// weighs as much.
constexpr double kIdleWeight = 0.02;
constexpr double kVelocityWeight = 4.0;

// Lengths that shrink by more than this per mm of fibre come near to what they may.
constexpr double kFreeShortening = 0.6;
constexpr double kShorteningWeight = 10.0;
// What lengthening by so little per mm of fibre costs is all the same.
constexpr double kMinRise = 0.1;

// A range that is not clear is halved so many times.
constexpr int kHalvings = 3;

// Solutions within bounds: what would leave them is held there, and the rest solved again.
constexpr int kBoundPasses = 3;

// Steps for derivatives.
constexpr double kTurnStep_rad = 1e-4;
constexpr double kLengthStep_mm = 0.01;

// How far a turn and a length may go in one round.
constexpr double kTurnReach_rad = 0.15;
constexpr double kLengthReach_mm = 12.0;
constexpr double kScan_mm = 4.0;

// Keeps the equations solvable where a variable has no say, and pivots positive in rounding.
constexpr double kMinDiagonal = 1e-9;
constexpr double kMinPivot = 1e-12;

struct Range {
    double low = 0.0;
    double high = 0.0;
};

// Symmetric positive matrices with entries up to kBand beside the diagonal.
class BandMatrix {
public:
    static constexpr std::size_t kBand = 5;

    explicit BandMatrix(std::size_t n) : row_(n) {
        for (auto& row : row_) {
            row.fill(0.0);
        }
    }

    // Entry (i, i - back).
    double& at(std::size_t i, std::size_t back) { return row_[i][back]; }

    // Solves in place by Cholesky's decomposition, which replaces the entries.
    void solve(std::vector<double>& x) {
        const std::size_t n = row_.size();
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t back = std::min(i, kBand); back > 0; --back) {
                const std::size_t j = i - back;
                double sum = row_[i][back];
                for (std::size_t more = 1; back + more <= kBand && more <= j; ++more) {
                    sum -= row_[i][back + more] * row_[j][more];
                }
                row_[i][back] = sum / row_[j][0];
            }
            double sum = row_[i][0];
            for (std::size_t back = 1; back <= std::min(i, kBand); ++back) {
                sum -= row_[i][back] * row_[i][back];
            }
            row_[i][0] = std::sqrt(std::max(sum, kMinPivot));
            for (std::size_t back = 1; back <= std::min(i, kBand); ++back) {
                x[i] -= row_[i][back] * x[i - back];
            }
            x[i] /= row_[i][0];
        }
        for (std::size_t i = n; i-- > 0;) {
            for (std::size_t ahead = 1; ahead <= kBand && i + ahead < n; ++ahead) {
                x[i] -= row_[i + ahead][ahead] * x[i + ahead];
            }
            x[i] /= row_[i][0];
        }
    }

private:
    std::vector<std::array<double, kBand + 1>> row_;
};

// Choices, and the axes there: knots x axes.
struct ChosenMotion {
    std::vector<KnotChoice> choices;
    std::vector<double> joints;
};

std::span<double> row(std::vector<double>& all, std::size_t k, std::size_t axes) {
    return {all.data() + k * axes, axes};
}

// The axes at all knots, one after the other.
ChosenMotion motion_of(const MotionKnots& knots, std::vector<KnotChoice> choices) {
    const std::size_t axes = knots.axis_count();
    ChosenMotion motion{std::move(choices), std::vector<double>(knots.size() * axes)};
    std::vector<double> previous(knots.start().begin(), knots.start().end());
    for (std::size_t k = 0; k < knots.size(); ++k) {
        const std::span<double> here = row(motion.joints, k, axes);
        knots.joints(k, motion.choices[k], previous, here);
        std::copy_n(here.begin(), axes, previous.begin());
    }
    return motion;
}

double velocity(const MotionKnots& knots, const ChosenMotion& motion, std::size_t k,
                std::size_t a) {
    const std::size_t axes = knots.axis_count();
    return (motion.joints[(k + 1) * axes + a] - motion.joints[k * axes + a]) / knots.step_s(k);
}

double acceleration_ratio(const MotionKnots& knots, const ChosenMotion& motion, std::size_t k,
                          std::size_t a) {
    return (velocity(knots, motion, k, a) - velocity(knots, motion, k - 1, a)) /
           (0.5 * (knots.step_s(k) + knots.step_s(k - 1)) * knots.axis(a).acceleration);
}

// Lengthening of the free fibre per mm that is laid, from a knot to the next.
double length_rise(const MotionKnots& knots, const ChosenMotion& motion, std::size_t k) {
    return (motion.choices[k + 1].length_mm - motion.choices[k].length_mm) / knots[k].ahead_mm;
}

// Estimate of the time.
double estimated_time_s(const MotionKnots& knots, const ChosenMotion& motion) {
    double sum = 0.0;
    std::vector<double> stretch(knots.size(), 1.0);  // per step
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
        double& s = stretch[k];
        s = std::max(s, 1.0 + length_rise(knots, motion, k));
        for (std::size_t a = 0; a < knots.axis_count(); ++a) {
            s = std::max(s, std::abs(velocity(knots, motion, k, a)) / knots.axis(a).velocity);
        }
    }
    for (std::size_t k = 1; k + 1 < knots.size(); ++k) {
        double s = 1.0;
        for (std::size_t a = 0; a < knots.axis_count(); ++a) {
            s = std::max(s, std::sqrt(std::abs(acceleration_ratio(knots, motion, k, a))));
        }
        stretch[k] = std::max(stretch[k], s);
        stretch[k - 1] = std::max(stretch[k - 1], s);
    }
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
        sum += stretch[k] * knots.step_s(k);
    }
    return sum;
}

// Ranges of turn and length around a choice that are clear.
struct ClearRange {
    Range turn_rad;
    Range length_mm;
};

ClearRange clear_range(const MotionKnots& knots, const std::vector<KnotChoice>& choices,
                       std::size_t k) {
    const KnotChoice at = choices[k];
    ClearRange range{{at.turn_rad, at.turn_rad}, {at.length_mm, at.length_mm}};
    if (knots[k].kept) {
        return range;
    }
    const auto clear = [&](double turn, double length) {
        const KnotChoice choice{turn, length};
        return knots.clear(k, choice) &&
               (k == 0 || knots.clear_between(k - 1, choices[k - 1], choice)) &&
               (k + 1 == knots.size() || knots.clear_between(k, choice, choices[k + 1]));
    };
    double reach = kTurnReach_rad;
    for (int i = 0; i < kHalvings && !(clear(at.turn_rad - reach, at.length_mm) &&
                                       clear(at.turn_rad + reach, at.length_mm));
         ++i) {
        reach = i + 1 < kHalvings ? 0.5 * reach : 0.0;
    }
    range.turn_rad = {at.turn_rad - reach, at.turn_rad + reach};
    if (knots.task().fixed_lengths) {
        return range;
    }
    const double least = std::min(at.length_mm, knots.least_mm(k));
    const double most = std::max(at.length_mm, knots[k].longest_mm);
    const auto free = [&](double length) {
        return clear(at.turn_rad - reach, length) && clear(at.turn_rad + reach, length);
    };
    for (const double side : {-1.0, 1.0}) {
        double& end = side < 0.0 ? range.length_mm.low : range.length_mm.high;
        for (double by = kScan_mm; by <= kLengthReach_mm; by += kScan_mm) {
            const double next = std::clamp(at.length_mm + side * by, least, most);
            if (!free(next)) {
                break;
            }
            end = next;
        }
    }
    return range;
}

std::vector<ClearRange> clear_ranges(const MotionKnots& knots,
                                     const std::vector<KnotChoice>& choices) {
    std::vector<ClearRange> ranges(knots.size());
    parallel_for(knots.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            ranges[k] = clear_range(knots, choices, k);
        }
    });
    return ranges;
}

// Derivatives of the axes by the choice at their knot: knots x axes.
struct AxisSlopes {
    std::vector<double> by_turn;
    std::vector<double> by_length;
};

AxisSlopes axis_slopes(const MotionKnots& knots, const ChosenMotion& motion) {
    const std::size_t axes = knots.axis_count();
    AxisSlopes slopes{std::vector<double>(motion.joints.size()),
                      std::vector<double>(motion.joints.size())};
    parallel_for(knots.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::span<const double> q(motion.joints.data() + k * axes, axes);
            const auto derive = [&](const KnotChoice& other, double by, std::span<double> out) {
                knots.joints(k, other, q, out);
                for (std::size_t a = 0; a < axes; ++a) {
                    out[a] = (out[a] - q[a]) / by;
                }
            };
            KnotChoice other = motion.choices[k];
            other.turn_rad += kTurnStep_rad;
            derive(other, kTurnStep_rad, row(slopes.by_turn, k, axes));
            other = motion.choices[k];
            other.length_mm += kLengthStep_mm;
            derive(other, kLengthStep_mm, row(slopes.by_length, k, axes));
        }
    });
    return slopes;
}

// What weighs a ratio in least squares so that its loss is the time it costs, the square root:
// the slope of that over the ratio.
double weight_of(double ratio) {
    const double r = std::abs(ratio);
    return kIdleWeight + (r <= kFreeAcceleration ? 0.0 : 1.0 / (r * std::sqrt(r)));
}

struct Term {
    std::size_t variable = 0;
    double slope = 0.0;
};

// The normal equations. Each knot has two variables, its turn and its length.
struct Equations {
    BandMatrix matrix;
    std::vector<double> right;

    void add(std::span<const Term> terms, double residual, double weight) {
        for (const Term& t : terms) {
            right[t.variable] -= weight * t.slope * residual;
            for (const Term& u : terms) {
                if (u.variable <= t.variable) {
                    matrix.at(t.variable, t.variable - u.variable) += weight * t.slope * u.slope;
                }
            }
        }
    }
};

// How an axis' value depends on the two variables of its knot, times a factor.
// \param at of the value: knot x axis
std::array<Term, 2> terms_of(const AxisSlopes& slopes, std::size_t k, std::size_t at,
                             double factor) {
    return {Term{2 * k, factor * slopes.by_turn[at] * kTurnUnit_rad},
            Term{2 * k + 1, factor * slopes.by_length[at] * kLengthUnit_mm}};
}

void add_accelerations(const MotionKnots& knots, const ChosenMotion& motion,
                       const AxisSlopes& slopes, Equations& equations) {
    const std::size_t axes = knots.axis_count();
    for (std::size_t k = 1; k + 1 < knots.size(); ++k) {
        const double before_s = knots.step_s(k - 1);
        const double after_s = knots.step_s(k);
        const double middle_s = 0.5 * (before_s + after_s);
        for (std::size_t a = 0; a < axes; ++a) {
            const double ratio = acceleration_ratio(knots, motion, k, a);
            const double unit = 1.0 / (middle_s * knots.axis(a).acceleration);
            const std::size_t at = k * axes + a;
            const auto before = terms_of(slopes, k - 1, at - axes, unit / before_s);
            const auto here = terms_of(slopes, k, at, -unit * (1.0 / before_s + 1.0 / after_s));
            const auto after = terms_of(slopes, k + 1, at + axes, unit / after_s);
            const std::array<Term, 6> terms{before[0], before[1], here[0],
                                            here[1],   after[0],  after[1]};
            equations.add(terms, ratio, middle_s * weight_of(ratio));
        }
    }
}

void add_velocities(const MotionKnots& knots, const ChosenMotion& motion, const AxisSlopes& slopes,
                    Equations& equations) {
    const std::size_t axes = knots.axis_count();
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
        const double step_s = knots.step_s(k);
        for (std::size_t a = 0; a < axes; ++a) {
            const double ratio = velocity(knots, motion, k, a) / knots.axis(a).velocity;
            if (std::abs(ratio) < kFreeVelocity) {
                continue;
            }
            const double unit = 1.0 / (step_s * knots.axis(a).velocity);
            const auto from = terms_of(slopes, k, k * axes + a, -unit);
            const auto to = terms_of(slopes, k + 1, (k + 1) * axes + a, unit);
            const std::array<Term, 4> terms{from[0], from[1], to[0], to[1]};
            equations.add(terms, ratio - std::copysign(kFreeVelocity, ratio),
                          kVelocityWeight * step_s);
        }
    }
}

// Fibre that runs out faster than it is laid costs time; lengths may not shrink too fast.
void add_lengths(const MotionKnots& knots, const ChosenMotion& motion, Equations& equations) {
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
        const double rise = length_rise(knots, motion, k);
        const double unit = kLengthUnit_mm / knots[k].ahead_mm;
        const std::array<Term, 2> terms{Term{2 * k + 1, -unit}, Term{2 * k + 3, unit}};
        if (rise > 0.0) {
            equations.add(terms, rise, knots.step_s(k) / std::max(rise, kMinRise));
        } else if (rise < -kFreeShortening) {
            equations.add(terms, rise + kFreeShortening, kShorteningWeight * knots.step_s(k));
        }
    }
}

Equations damped_equations(const MotionKnots& knots, const ChosenMotion& motion,
                           const AxisSlopes& slopes, double damping) {
    const std::size_t variables = 2 * knots.size();
    Equations equations{BandMatrix(variables), std::vector<double>(variables, 0.0)};
    add_accelerations(knots, motion, slopes, equations);
    add_velocities(knots, motion, slopes, equations);
    add_lengths(knots, motion, equations);
    for (std::size_t i = 0; i < variables; ++i) {
        equations.matrix.at(i, 0) += damping * knots.step_s(0) + kMinDiagonal;
    }
    return equations;
}

// What each variable may change by.
std::vector<Range> bounds_of(const std::vector<KnotChoice>& choices,
                             const std::vector<ClearRange>& ranges) {
    const auto bound = [](double unit, double at, const Range& range) {
        return Range{(range.low - at) / unit, (range.high - at) / unit};
    };
    std::vector<Range> bounds;
    bounds.reserve(2 * choices.size());
    for (std::size_t k = 0; k < choices.size(); ++k) {
        bounds.push_back(bound(kTurnUnit_rad, choices[k].turn_rad, ranges[k].turn_rad));
        bounds.push_back(bound(kLengthUnit_mm, choices[k].length_mm, ranges[k].length_mm));
    }
    return bounds;
}

// The solution with some variables held where they are in `move`.
std::vector<double> solve_with(const Equations& equations, const std::vector<char>& held,
                               const std::vector<double>& move) {
    BandMatrix matrix = equations.matrix;
    std::vector<double> x = equations.right;
    const std::size_t n = x.size();
    for (std::size_t i = 0; i < n; ++i) {
        if (held[i] == 0) {
            continue;
        }
        for (std::size_t back = 1; back <= std::min(i, BandMatrix::kBand); ++back) {
            x[i - back] -= matrix.at(i, back) * move[i];
            matrix.at(i, back) = 0.0;
        }
        for (std::size_t ahead = 1; ahead <= BandMatrix::kBand && i + ahead < n; ++ahead) {
            x[i + ahead] -= matrix.at(i + ahead, ahead) * move[i];
            matrix.at(i + ahead, ahead) = 0.0;
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (held[i] != 0) {
            matrix.at(i, 0) = 1.0;
            x[i] = move[i];
        }
    }
    matrix.solve(x);
    return x;
}

// Holds variables that leave their bounds there; whether any does.
bool hold_within(const std::vector<Range>& bounds, std::vector<double>& move,
                 std::vector<char>& held) {
    bool any = false;
    for (std::size_t i = 0; i < move.size(); ++i) {
        if (move[i] < bounds[i].low || move[i] > bounds[i].high) {
            move[i] = std::clamp(move[i], bounds[i].low, bounds[i].high);
            held[i] = 1;
            any = true;
        }
    }
    return any;
}

std::vector<double> solve_within(const Equations& equations, const std::vector<Range>& bounds) {
    std::vector<char> held(bounds.size(), 0);
    std::vector<double> move;
    for (int pass = 0; pass < kBoundPasses; ++pass) {
        move = solve_with(equations, held, move);
        if (!hold_within(bounds, move, held)) {
            break;
        }
    }
    return move;
}

std::vector<KnotChoice> moved_by(std::vector<KnotChoice> choices, const std::vector<double>& move) {
    for (std::size_t k = 0; k < choices.size(); ++k) {
        choices[k].turn_rad += kTurnUnit_rad * move[2 * k];
        choices[k].length_mm += kLengthUnit_mm * move[2 * k + 1];
    }
    return choices;
}

}  // namespace

std::vector<KnotChoice> smooth_motion(const MotionKnots& knots, std::vector<KnotChoice> choices) {
    ChosenMotion best = motion_of(knots, std::move(choices));
    double best_s = estimated_time_s(knots, best);
    double damping = kFirstDamping;
    std::vector<ClearRange> ranges;
    AxisSlopes slopes;
    bool moved = true;
    for (int round = 0; round < kRounds; ++round) {
        if (moved) {
            ranges = clear_ranges(knots, best.choices);
            slopes = axis_slopes(knots, best);
        }
        const Equations equations = damped_equations(knots, best, slopes, damping);
        const std::vector<double> move = solve_within(equations, bounds_of(best.choices, ranges));
        ChosenMotion next = motion_of(knots, moved_by(best.choices, move));
        const double next_s = estimated_time_s(knots, next);
        moved = next_s < best_s;
        if (moved) {
            best_s = next_s;
            best = std::move(next);
        }
        damping *= moved ? kLessDamping : kMoreDamping;
    }
    return best.choices;
}

}  // namespace meshwind
