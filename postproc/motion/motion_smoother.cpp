// The smoothing of optimal_motion.h.
#include <algorithm>
#include <array>
#include <cmath>

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
constexpr double kLeastRise = 0.1;

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
constexpr double kLeastDiagonal = 1e-9;
constexpr double kLeastPivot = 1e-12;

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
            row_[i][0] = std::sqrt(std::max(sum, kLeastPivot));
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

class Smoother {
public:
    Smoother(const MotionKnots& knots, std::vector<KnotChoice> choices)
        : knots_(knots), axes_(knots.axis_count()), choices_(std::move(choices)) {}

    std::vector<KnotChoice> run() {
        evaluate();
        std::vector<KnotChoice> best = choices_;
        std::vector<double> best_joints = joints_;
        double best_s = time_s();
        double damping = kFirstDamping;
        bool moved = true;
        for (int round = 0; round < kRounds; ++round) {
            if (moved) {
                find_ranges();
                differentiate();
            }
            step(damping);
            evaluate();
            const double now = time_s();
            moved = now < best_s;
            if (moved) {
                best_s = now;
                best = choices_;
                best_joints = joints_;
                damping *= kLessDamping;
            } else {
                choices_ = best;
                joints_ = best_joints;
                damping *= kMoreDamping;
            }
        }
        return best;
    }

private:
    [[nodiscard]] std::span<double> row(std::vector<double>& all, std::size_t k) const {
        return {all.data() + k * axes_, axes_};
    }

    // The axes at all knots, one after the other.
    void evaluate() {
        joints_.resize(knots_.size() * axes_);
        std::vector<double> previous(knots_.start().begin(), knots_.start().end());
        for (std::size_t k = 0; k < knots_.size(); ++k) {
            knots_.joints(k, choices_[k], previous, row(joints_, k));
            std::copy_n(row(joints_, k).begin(), axes_, previous.begin());
        }
    }

    void differentiate() {
        by_turn_.resize(joints_.size());
        by_length_.resize(joints_.size());
        parallel_for(knots_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                const std::span<double> q = row(joints_, k);
                const auto derive = [&](const KnotChoice& other, double by, std::span<double> out) {
                    knots_.joints(k, other, q, out);
                    for (std::size_t a = 0; a < axes_; ++a) {
                        out[a] = (out[a] - q[a]) / by;
                    }
                };
                KnotChoice other = choices_[k];
                other.turn_rad += kTurnStep_rad;
                derive(other, kTurnStep_rad, row(by_turn_, k));
                other = choices_[k];
                other.length_mm += kLengthStep_mm;
                derive(other, kLengthStep_mm, row(by_length_, k));
            }
        });
    }

    [[nodiscard]] double velocity(std::size_t k, std::size_t a) const {
        return (joints_[(k + 1) * axes_ + a] - joints_[k * axes_ + a]) / knots_.step_s(k);
    }

    [[nodiscard]] double acceleration_ratio(std::size_t k, std::size_t a) const {
        return (velocity(k, a) - velocity(k - 1, a)) /
               (0.5 * (knots_.step_s(k) + knots_.step_s(k - 1)) * knots_.axis(a).acceleration);
    }

    // Estimate of the time.
    [[nodiscard]] double time_s() const {
        double sum = 0.0;
        std::vector<double> stretch(knots_.size(), 1.0);  // per step
        for (std::size_t k = 0; k + 1 < knots_.size(); ++k) {
            double& s = stretch[k];
            s = std::max(
                s, 1.0 + (choices_[k + 1].length_mm - choices_[k].length_mm) / knots_[k].ahead_mm);
            for (std::size_t a = 0; a < axes_; ++a) {
                s = std::max(s, std::abs(velocity(k, a)) / knots_.axis(a).velocity);
            }
        }
        for (std::size_t k = 1; k + 1 < knots_.size(); ++k) {
            double s = 1.0;
            for (std::size_t a = 0; a < axes_; ++a) {
                s = std::max(s, std::sqrt(std::abs(acceleration_ratio(k, a))));
            }
            stretch[k] = std::max(stretch[k], s);
            stretch[k - 1] = std::max(stretch[k - 1], s);
        }
        for (std::size_t k = 0; k + 1 < knots_.size(); ++k) {
            sum += stretch[k] * knots_.step_s(k);
        }
        return sum;
    }

    // Ranges of turn and length around each choice that are clear.
    void find_ranges() {
        turn_.resize(knots_.size());
        length_.resize(knots_.size());
        parallel_for(knots_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                find_range(k);
            }
        });
    }

    void find_range(std::size_t k) {
        const KnotChoice at = choices_[k];
        turn_[k] = {at.turn_rad, at.turn_rad};
        length_[k] = {at.length_mm, at.length_mm};
        if (knots_[k].kept) {
            return;
        }
        const auto clear = [&](double turn, double length) {
            const KnotChoice choice{turn, length};
            return knots_.clear(k, choice) &&
                   (k == 0 || knots_.clear_between(k - 1, choices_[k - 1], choice)) &&
                   (k + 1 == knots_.size() || knots_.clear_between(k, choice, choices_[k + 1]));
        };
        double reach = kTurnReach_rad;
        for (int i = 0; i < kHalvings && !(clear(at.turn_rad - reach, at.length_mm) &&
                                           clear(at.turn_rad + reach, at.length_mm));
             ++i) {
            reach = i + 1 < kHalvings ? 0.5 * reach : 0.0;
        }
        turn_[k] = {at.turn_rad - reach, at.turn_rad + reach};
        if (knots_.task().fixed_lengths) {
            return;
        }
        const double least = std::min(at.length_mm, knots_.least_mm(k));
        const double most = std::max(at.length_mm, knots_[k].longest_mm);
        const auto free = [&](double length) {
            return clear(at.turn_rad - reach, length) && clear(at.turn_rad + reach, length);
        };
        for (const double side : {-1.0, 1.0}) {
            double& end = side < 0.0 ? length_[k].low : length_[k].high;
            for (double by = kScan_mm; by <= kLengthReach_mm; by += kScan_mm) {
                const double next = std::clamp(at.length_mm + side * by, least, most);
                if (!free(next)) {
                    break;
                }
                end = next;
            }
        }
    }

    // What weighs a ratio in least squares so that its loss is the time it costs, the square root:
    // the slope of that over the ratio.
    static double weight(double ratio) {
        const double r = std::abs(ratio);
        return kIdleWeight + (r <= kFreeAcceleration ? 0.0 : 1.0 / (r * std::sqrt(r)));
    }

    struct Term {
        std::size_t variable = 0;
        double slope = 0.0;
    };

    // The normal equations.
    struct Equations {
        BandMatrix matrix;
        std::vector<double> right;

        void add(std::span<const Term> terms, double residual, double weight) {
            for (const Term& t : terms) {
                right[t.variable] -= weight * t.slope * residual;
                for (const Term& u : terms) {
                    if (u.variable <= t.variable) {
                        matrix.at(t.variable, t.variable - u.variable) +=
                            weight * t.slope * u.slope;
                    }
                }
            }
        }
    };

    // How an axis' value at a place depends on its two variables, times a factor.
    [[nodiscard]] std::array<Term, 2> terms_of(std::size_t k, std::size_t axis,
                                               double factor) const {
        return {Term{2 * k, factor * by_turn_[k * axes_ + axis] * kTurnUnit_rad},
                Term{2 * k + 1, factor * by_length_[k * axes_ + axis] * kLengthUnit_mm}};
    }

    void add_accelerations(Equations& equations) const {
        for (std::size_t k = 1; k + 1 < knots_.size(); ++k) {
            const double before_s = knots_.step_s(k - 1);
            const double after_s = knots_.step_s(k);
            const double middle_s = 0.5 * (before_s + after_s);
            for (std::size_t a = 0; a < axes_; ++a) {
                const double ratio = acceleration_ratio(k, a);
                const double unit = 1.0 / (middle_s * knots_.axis(a).acceleration);
                const auto before = terms_of(k - 1, a, unit / before_s);
                const auto here = terms_of(k, a, -unit * (1.0 / before_s + 1.0 / after_s));
                const auto after = terms_of(k + 1, a, unit / after_s);
                const std::array<Term, 6> terms{before[0], before[1], here[0],
                                                here[1],   after[0],  after[1]};
                equations.add(terms, ratio, middle_s * weight(ratio));
            }
        }
    }

    void add_velocities(Equations& equations) const {
        for (std::size_t k = 0; k + 1 < knots_.size(); ++k) {
            const double step_s = knots_.step_s(k);
            for (std::size_t a = 0; a < axes_; ++a) {
                const double ratio = velocity(k, a) / knots_.axis(a).velocity;
                if (std::abs(ratio) < kFreeVelocity) {
                    continue;
                }
                const double unit = 1.0 / (step_s * knots_.axis(a).velocity);
                const auto from = terms_of(k, a, -unit);
                const auto to = terms_of(k + 1, a, unit);
                const std::array<Term, 4> terms{from[0], from[1], to[0], to[1]};
                equations.add(terms, ratio - std::copysign(kFreeVelocity, ratio),
                              kVelocityWeight * step_s);
            }
        }
    }

    // Fibre that runs out faster than it is laid costs time; lengths may not shrink too fast.
    void add_lengths(Equations& equations) const {
        for (std::size_t k = 0; k + 1 < knots_.size(); ++k) {
            const double rise =
                (choices_[k + 1].length_mm - choices_[k].length_mm) / knots_[k].ahead_mm;
            const double unit = kLengthUnit_mm / knots_[k].ahead_mm;
            const std::array<Term, 2> terms{Term{2 * k + 1, -unit}, Term{2 * k + 3, unit}};
            if (rise > 0.0) {
                equations.add(terms, rise, knots_.step_s(k) / std::max(rise, kLeastRise));
            } else if (rise < -kFreeShortening) {
                equations.add(terms, rise + kFreeShortening, kShorteningWeight * knots_.step_s(k));
            }
        }
    }

    // One step of the method.
    void step(double damping) {
        const std::size_t n = knots_.size();
        Equations equations{BandMatrix(2 * n), std::vector<double>(2 * n, 0.0)};
        add_accelerations(equations);
        add_velocities(equations);
        add_lengths(equations);
        for (std::size_t i = 0; i < 2 * n; ++i) {
            equations.matrix.at(i, 0) += damping * knots_.step_s(0) + kLeastDiagonal;
        }
        std::vector<char> held(2 * n, 0);
        for (int pass = 0; pass < kBoundPasses; ++pass) {
            move_ = solve_with(equations, held);
            bool any = false;
            for (std::size_t k = 0; k < n; ++k) {
                any = hold(2 * k, kTurnUnit_rad, choices_[k].turn_rad, turn_[k], held) || any;
                any =
                    hold(2 * k + 1, kLengthUnit_mm, choices_[k].length_mm, length_[k], held) || any;
            }
            if (!any) {
                break;
            }
        }
        for (std::size_t k = 0; k < n; ++k) {
            choices_[k].turn_rad += kTurnUnit_rad * move_[2 * k];
            choices_[k].length_mm += kLengthUnit_mm * move_[2 * k + 1];
        }
    }

    // The solution with some variables held where they are in move_.
    [[nodiscard]] std::vector<double> solve_with(const Equations& equations,
                                                 const std::vector<char>& held) const {
        BandMatrix matrix = equations.matrix;
        std::vector<double> x = equations.right;
        const std::size_t n = x.size();
        for (std::size_t i = 0; i < n; ++i) {
            if (held[i] == 0) {
                continue;
            }
            for (std::size_t back = 1; back <= std::min(i, BandMatrix::kBand); ++back) {
                x[i - back] -= matrix.at(i, back) * move_[i];
                matrix.at(i, back) = 0.0;
            }
            for (std::size_t ahead = 1; ahead <= BandMatrix::kBand && i + ahead < n; ++ahead) {
                x[i + ahead] -= matrix.at(i + ahead, ahead) * move_[i];
                matrix.at(i + ahead, ahead) = 0.0;
            }
        }
        for (std::size_t i = 0; i < n; ++i) {
            if (held[i] != 0) {
                matrix.at(i, 0) = 1.0;
                x[i] = move_[i];
            }
        }
        matrix.solve(x);
        return x;
    }

    bool hold(std::size_t i, double unit, double at, const Range& range, std::vector<char>& held) {
        const double low = (range.low - at) / unit;
        const double high = (range.high - at) / unit;
        const bool beyond = move_[i] < low || move_[i] > high;
        if (beyond) {
            move_[i] = std::clamp(move_[i], low, high);
            held[i] = 1;
        }
        return beyond;
    }

    const MotionKnots& knots_;
    std::size_t axes_;
    std::vector<KnotChoice> choices_;
    std::vector<double> joints_;
    std::vector<double> by_turn_;
    std::vector<double> by_length_;
    std::vector<Range> turn_;
    std::vector<Range> length_;
    std::vector<double> move_;
};

}  // namespace

std::vector<KnotChoice> smooth_motion(const MotionKnots& knots, std::vector<KnotChoice> choices) {
    return Smoother(knots, std::move(choices)).run();
}

}  // namespace meshwind
