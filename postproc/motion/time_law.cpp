#include "postproc/motion/time_law.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numeric>

#include <Eigen/Core>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/text/text_number.h"
#include "machines/kinematics.h"

namespace meshwind {
namespace {

// Rounding of sums against limits that are just kept.
constexpr double kSlack = 1e-9;

// Sweeps over the path, at most; a step is lengthened by no less than a part of this many.
constexpr int kMostSweeps = 200;
constexpr double kSweepSlack = 1e-4;

// A duration that is a whole number of ticks up to rounding is not one tick more.
constexpr double kWholeTick = 1e-6;

// Keeps 0/0 of an axis at rest apart.
constexpr double kLeast_s = 1e-300;

// Slowing down lengthens a step without room by the square root of what it lacks, within these, so
// that it neither creeps nor overshoots by much.
constexpr double kLeastSlowing = 1.001;
constexpr double kMostSlowing = 1.3;

// Shares by which all steps may become shorter or longer at once, in turn, each for as long as it
// saves this part of the share.
constexpr std::array<double, 9> kShares = {0.5, 0.25, 0.12, 0.06, 0.03, 0.015, 0.007, 0.003, 0.001};
constexpr double kWorthwhile = 0.01;
constexpr int kMostRounds = 30;

// What happens at a step matters to so many before and after.
constexpr std::size_t kReach = 3;

// Durations of a step to choose from: shorter, as it is, longer.
constexpr std::size_t kChoices = 3;
constexpr std::size_t kPairs = kChoices * kChoices;

using Costs = std::array<double, kPairs>;  // of choice i of a step and j of the next

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Index of what sets a step's duration: the fibre, a corner, then three for each axis.
constexpr std::size_t kFibre = 0;
constexpr std::size_t kCorner = 1;
enum AxisLimit : std::size_t { Velocity, Acceleration, Jerk };
std::size_t limit_index(AxisLimit kind, std::size_t joint) {
    return 2 + 3 * joint + kind;
}

std::string limit_name(const Machine& machine, std::size_t limit) {
    if (limit == kFibre || limit == kCorner) {
        return limit == kFibre ? "fibre" : "corner";
    }
    const char* const kinds[] = {" velocity", " acceleration", " jerk"};
    return std::string(1, machine.axis((limit - 2) / 3).letter) + kinds[(limit - 2) % 3];
}

// Axes by fours, for the processor takes several at once. Velocities are over acceleration, so that
// their differences are the times of ramps.
using Lanes = Eigen::Array4d;
constexpr std::size_t kLanes = 4;

// A path's moving steps, 1 .. count; 0 and count + 1 are rest.
class TimeLaw {
public:
    TimeLaw(const Machine& machine, const JointPath& joints, std::span<const double> fibre_mm,
            const TimeLawOptions& options)
        : machine_(machine),
          axes_(joints.axis_count),
          groups_((axes_ + kLanes - 1) / kLanes),
          corner_mm_(options.corner_mm) {
        const double fibre_mm_s = std::min(options.fibre_speed_mm_s, machine.fibre.max_speed_mm_s);
        add_axes();
        add_step(0, 1.0, kFibre);
        for (std::size_t i = 1; i < joints.size(); ++i) {
            add_moving_step(i, joints, fibre_mm[i] / fibre_mm_s);
        }
        count_ = step_.size() - 1;
        add_step(0, 1.0, kFibre);
        duration_s_ = least_s_;
        add_corners(joints);
    }

    // Makes each step long enough to ramp up from the one before it, and down to the one after,
    // with half of both for a ramp. Axes that are slower than beside are left to the pass the other
    // way.
    void sweep() {
        std::vector<char> up(count_ + 2, 1);  // to be looked at: it or its neighbour has changed
        std::vector<char> down = up;
        const auto visit = [&](std::vector<char>& open, std::size_t m, std::size_t neighbour) {
            if (open[m] == 0) {
                return false;
            }
            open[m] = 0;
            const bool changed = adapt(m, neighbour);
            if (changed) {
                up[m] = up[m + 1] = down[m] = down[m - 1] = 1;
            }
            return changed;
        };
        bool changed = true;
        for (int sweeps = 0; changed && sweeps < kMostSweeps; ++sweeps) {
            check_interrupt();
            changed = false;
            for (std::size_t m = 1; m <= count_; ++m) {
                changed = visit(up, m, m - 1) || changed;
            }
            for (std::size_t m = count_; m > 0; --m) {
                changed = visit(down, m, m + 1) || changed;
            }
        }
    }

    // Lengthens what still has no room for its ramps or cuts a corner too far, with its
    // neighbours. It ends, for what is long enough always has.
    void slow_down() {
        std::vector<char> open(count_ + 4, 1);  // at 1 + m: to be looked at
        for (bool changed = true; changed;) {
            check_interrupt();
            changed = false;
            for (std::size_t m = 1; m <= count_; ++m) {
                if (open[1 + m] == 0) {
                    continue;
                }
                open[1 + m] = 0;
                const double lacks = std::max(room_ratio(m), std::sqrt(corner_ratio(m)));
                if (lacks > 1.0 + kSlack) {
                    const double longer = std::clamp(std::sqrt(lacks), kLeastSlowing, kMostSlowing);
                    lengthen(m, longer);
                    if (m > 1) {
                        lengthen(m - 1, std::sqrt(longer));
                    }
                    if (m < count_) {
                        lengthen(m + 1, std::sqrt(longer));
                    }
                    std::fill_n(open.begin() + static_cast<std::ptrdiff_t>(m) - 1, 5, 1);
                    changed = true;
                }
            }
        }
    }

    // Durations of whole ticks, none shorter than it was; 0: as they are.
    void keep_ticks(double tick_s) {
        tick_s_ = tick_s;
        for (std::size_t m = 1; m <= count_; ++m) {
            lengthen(m, 1.0);
        }
        slow_down();
    }

    void tighten() {
        for (const double share : kShares) {
            double saved = 1.0;  // share of the time
            changed_.assign(count_ + 2, 1);
            for (int round = 0; round < kMostRounds && saved > kWorthwhile * share; ++round) {
                const double before_s = sum_s();
                choose(1.0 + share);
                saved = 1.0 - sum_s() / before_s;
            }
        }
    }

    [[nodiscard]] TimedPath result(std::size_t points) const {
        TimedPath timed;
        timed.step_s.assign(points, 0.0);
        for (std::size_t m = 1; m <= count_; ++m) {
            timed.step_s[step_[m]] = duration_s_[m];
        }
        timed.ramp_s = count_ > 0 ? 0.5 * (longest_ramp_s(0) + longest_ramp_s(count_)) : 0.0;
        timed.duration_s = timed.ramp_s;
        for (const double step_s : timed.step_s) {
            timed.duration_s += step_s;
        }
        timed.binding = binding();
        return timed;
    }

private:
    void lengthen(std::size_t m, double factor) {
        duration_s_[m] *= factor;
        if (tick_s_ > 0.0) {
            duration_s_[m] = tick_s_ * std::ceil(duration_s_[m] / tick_s_ - kWholeTick);
        }
    }

    [[nodiscard]] double sum_s() const {
        return std::accumulate(duration_s_.begin(), duration_s_.end(), 0.0);
    }

    void add_axes() {
        build_up_s_.assign(groups_, Lanes::Zero());
        cut_mm_s2_.assign(groups_, Lanes::Zero());
        for (std::size_t a = 0; a < axes_; ++a) {
            const Axis& axis = machine_.axis(a);
            const auto lane = static_cast<Eigen::Index>(a % kLanes);
            build_up_s_[a / kLanes][lane] = axis.acceleration / axis.jerk;
            limited_jerk_ = limited_jerk_ || !std::isinf(axis.jerk);
            if (axis.type == AxisType::Linear) {
                cut_mm_s2_[a / kLanes][lane] = axis.acceleration / 8.0;
            }
        }
    }

    // How ramps move the eye at each corner, where that is limited.
    void add_corners(const JointPath& joints) {
        if (std::isinf(corner_mm_)) {
            return;
        }
        eye_mm_s2_.assign((count_ + 1) * groups_ * 3, Lanes::Zero());
        for (std::size_t m = 1; m < count_; ++m) {
            const Eigen::Matrix3Xd moves = eye_moves(machine_, joints.row(step_[m]));
            for (std::size_t a = 0; a < axes_; ++a) {
                for (std::size_t k = 0; k < 3; ++k) {
                    eye_mm_s2_[(m * groups_ + a / kLanes) * 3 +
                               k][static_cast<Eigen::Index>(a % kLanes)] =
                        moves(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(a)) *
                        machine_.axis(a).acceleration / 8.0;
                }
            }
        }
    }

    // The linear axes and the eye at the corner after a step.
    struct Cut {
        double linear_mm2 = 0.0;
        std::array<double, 3> eye_mm{};

        [[nodiscard]] double mm2() const {
            return std::max(linear_mm2,
                            eye_mm[0] * eye_mm[0] + eye_mm[1] * eye_mm[1] + eye_mm[2] * eye_mm[2]);
        }
    };

    void add_cut(std::size_t m, std::size_t group, const Lanes& change_s, const Lanes& ramp_s,
                 Cut& cut) const {
        const Lanes moment_s2 = change_s * ramp_s;
        cut.linear_mm2 += (cut_mm_s2_[group] * moment_s2).square().sum();
        for (std::size_t k = 0; k < 3; ++k) {
            cut.eye_mm[k] += (eye_mm_s2_[(m * groups_ + group) * 3 + k] * moment_s2).sum();
        }
    }

    // At rest, so far.
    void add_step(std::size_t step, double least_s, std::size_t limit) {
        step_.push_back(step);
        least_s_.push_back(least_s);
        least_of_.push_back(limit);
        move_.resize(move_.size() + groups_, Lanes::Zero());
    }

    void add_moving_step(std::size_t step, const JointPath& joints, double fibre_s) {
        double least_s = fibre_s;
        std::size_t limit = kFibre;
        const auto move = [&](std::size_t a) {
            return joints.row(step)[a] - joints.row(step - 1)[a];
        };
        for (std::size_t a = 0; a < axes_; ++a) {
            const double axis_s = std::abs(move(a)) / machine_.axis(a).velocity;
            limit = axis_s > least_s ? limit_index(Velocity, a) : limit;
            least_s = std::max(least_s, axis_s);
        }
        if (least_s <= 0.0) {
            return;
        }
        add_step(step, least_s, limit);
        Lanes* const moves = &move_[move_.size() - groups_];
        for (std::size_t a = 0; a < axes_; ++a) {
            moves[a / kLanes][static_cast<Eigen::Index>(a % kLanes)] =
                move(a) / machine_.axis(a).acceleration;
        }
    }

    bool adapt(std::size_t m, std::size_t neighbour) {
        const bool rests = neighbour == 0 || neighbour > count_;
        const double room_s = rests ? kInfinity : duration_s_[neighbour];
        double longest_s = 0.0;
        for (std::size_t g = 0; g < groups_; ++g) {
            const Lanes move = move_[m * groups_ + g];
            const Lanes size = move.abs();
            const Lanes other = move_[neighbour * groups_ + g] / duration_s_[neighbour];
            const Lanes v = other.abs();
            // Both sides of a reversal have half of the ramp to themselves.
            const Lanes alone = (2.0 * size).sqrt().max(2.0 * size / room_s);
            const Lanes shared = (2.0 * size / (v + (v.square() + 4.0 * size).sqrt()).max(kLeast_s))
                                     .max(size / (v + room_s));
            const Lanes faster = (size > v * duration_s_[m]).select(shared, 0.0);
            longest_s = std::max(longest_s, (move * other < 0.0).select(alone, faster).maxCoeff());
        }
        const bool longer = longest_s > duration_s_[m] * (1.0 + kSweepSlack);
        duration_s_[m] = longer ? longest_s : duration_s_[m];
        return longer;
    }

    // Changes of velocity at full acceleration, without jerk.
    [[nodiscard]] Lanes change_s(std::size_t m, std::size_t group) const {
        return move_[(m + 1) * groups_ + group] / duration_s_[m + 1] -
               move_[m * groups_ + group] / duration_s_[m];
    }
    [[nodiscard]] Lanes at_once_s(std::size_t m, std::size_t group) const {
        return change_s(m, group).abs();
    }

    // As axis_loads.h has it, of all lanes.
    [[nodiscard]] Lanes ramps_s(const Lanes& jump_s, std::size_t group) const {
        if (!limited_jerk_) {
            return jump_s;
        }
        const Lanes& build_up_s = build_up_s_[group];
        return (jump_s >= build_up_s)
            .select(jump_s + build_up_s, 2.0 * (jump_s * build_up_s).sqrt());
    }

    // Between step m and the next.
    [[nodiscard]] Lanes ramps_s(std::size_t m, std::size_t group) const {
        return ramps_s(at_once_s(m, group), group);
    }

    [[nodiscard]] double longest_ramp_s(std::size_t m) const {
        double longest = 0.0;
        for (std::size_t g = 0; g < groups_; ++g) {
            longest = std::max(longest, ramps_s(m, g).maxCoeff());
        }
        return longest;
    }

    // Half of both ramps of a step over its duration: the worst axis'.
    [[nodiscard]] double room_ratio(std::size_t m) const {
        double worst_s = 0.0;
        for (std::size_t g = 0; g < groups_; ++g) {
            worst_s = std::max(worst_s, (ramps_s(m - 1, g) + ramps_s(m, g)).maxCoeff());
        }
        return 0.5 * worst_s / duration_s_[m];
    }

    // Of the corner after step m; starting and stopping are none.
    [[nodiscard]] double corner_ratio(std::size_t m) const {
        if (m == 0 || m == count_ || std::isinf(corner_mm_)) {
            return 0.0;
        }
        Cut cut;
        for (std::size_t g = 0; g < groups_; ++g) {
            add_cut(m, g, change_s(m, g), ramps_s(m, g), cut);
        }
        return std::sqrt(cut.mm2()) / corner_mm_;
    }

    // Durations of a step to choose from, and the velocities that they give.
    struct Choices {
        std::array<double, kChoices> duration_s{};
        std::size_t count = 0;
        std::vector<Lanes> velocity_s;  // choices x groups
    };

    // What a step and the next may last: the ramps between, by pairs.
    struct Corner {
        std::vector<Lanes> ramp_s;  // pairs x groups
        std::array<char, kPairs> allowed{};
    };

    // Marks the steps that have a choice: not those far from all that changed in the round before,
    // and not those at their least among others at theirs.
    void open_steps() {
        open_.assign(count_ + 2, 0);
        std::size_t changed = 0;  // how long ago, in steps
        std::size_t longer = 0;
        const auto pass = [&](std::size_t m) {
            changed = changed_[m] != 0 ? 0 : changed + 1;
            longer = duration_s_[m] > least_s_[m] ? 0 : longer + 1;
            open_[m] = static_cast<char>(open_[m] | (changed <= kReach ? 1 : 0) |
                                         (longer <= kReach ? 2 : 0));
        };
        changed = longer = kReach;
        for (std::size_t m = 1; m <= count_; ++m) {
            pass(m);
        }
        changed = longer = kReach;
        for (std::size_t m = count_; m > 0; --m) {
            pass(m);
        }
    }

    void list_durations(std::size_t m, double factor, Choices& choices) const {
        const double now_s = duration_s_[m];
        if (open_[m] != 3) {
            choices.duration_s = {now_s};
            choices.count = 1;
        } else if (now_s <= least_s_[m]) {
            choices.duration_s = {now_s, now_s * factor};
            choices.count = 2;
        } else {
            choices.duration_s = {std::max(now_s / factor, least_s_[m]), now_s, now_s * factor};
            choices.count = kChoices;
        }
        for (std::size_t i = 0; i < choices.count; ++i) {
            const double rate = 1.0 / choices.duration_s[i];
            for (std::size_t g = 0; g < groups_; ++g) {
                choices.velocity_s[i * groups_ + g] = rate * move_[m * groups_ + g];
            }
        }
    }

    void measure(std::size_t m, const Choices& here, const Choices& next, Corner& corner) const {
        const bool cuts = m != 0 && m != count_ && !std::isinf(corner_mm_);
        for (std::size_t i = 0; i < here.count; ++i) {
            for (std::size_t j = 0; j < next.count; ++j) {
                const std::size_t pair = i * kChoices + j;
                Cut cut;
                for (std::size_t g = 0; g < groups_; ++g) {
                    const Lanes change_s =
                        next.velocity_s[j * groups_ + g] - here.velocity_s[i * groups_ + g];
                    const Lanes ramp_s = ramps_s(change_s.abs(), g);
                    corner.ramp_s[pair * groups_ + g] = ramp_s;
                    if (cuts) {
                        add_cut(m, g, change_s, ramp_s, cut);
                    }
                }
                corner.allowed[pair] =
                    cut.mm2() <= corner_mm_ * corner_mm_ * (1.0 + kSlack) ? 1 : 0;
            }
        }
    }

    [[nodiscard]] bool fits(const Lanes* before, const Lanes* after, double duration_s) const {
        const double room_s = 2.0 * duration_s * (1.0 + kSlack);
        for (std::size_t g = 0; g < groups_; ++g) {
            if ((before[g] + after[g]).maxCoeff() > room_s) {
                return false;
            }
        }
        return true;
    }

    // The best of all choices for all steps. As they are is one of them, so it never gets worse.
    void choose(double factor) {
        open_steps();
        from_.resize(count_ + 1);
        offered_s_.resize(count_ + 1);
        std::array<Choices, 3> three;  // of the step before, this, and the next
        for (Choices& choices : three) {
            choices.velocity_s.resize(kChoices * groups_);
        }
        Corner before{std::vector<Lanes>(kPairs * groups_), {}};
        Corner after = before;
        Costs cost{};
        list_durations(0, factor, three[0]);
        list_durations(1, factor, three[1]);
        measure(0, three[0], three[1], before);
        check_interrupt();
        for (std::size_t m = 1; m <= count_; ++m) {
            const Choices& last = three[(m - 1) % 3];
            const Choices& here = three[m % 3];
            Choices& next = three[(m + 1) % 3];
            list_durations(m + 1, factor, next);
            measure(m, here, next, after);
            offered_s_[m] = here.duration_s;
            Costs now;
            now.fill(kInfinity);
            for (std::size_t j = 0; j < here.count; ++j) {
                for (std::size_t k = 0; k < next.count; ++k) {
                    const std::size_t to = j * kChoices + k;
                    for (std::size_t i = 0; after.allowed[to] != 0 && i < last.count; ++i) {
                        const std::size_t pair = i * kChoices + j;
                        const double sum_s = cost[pair] + here.duration_s[j];
                        if (sum_s < now[to] &&
                            fits(&before.ramp_s[pair * groups_], &after.ramp_s[to * groups_],
                                 here.duration_s[j])) {
                            now[to] = sum_s;
                            from_[m][to] = static_cast<std::uint8_t>(i);
                        }
                    }
                }
            }
            // Less the least, so that equal circuits give equal numbers wherever they are.
            const double least_s = *std::min_element(now.begin(), now.end());
            for (std::size_t pair = 0; pair < kPairs; ++pair) {
                cost[pair] = now[pair] - least_s;
            }
            std::swap(before, after);
        }
        take(cost);
    }

    // Goes back along the best choice. The last step is beside rest, which has one choice.
    void take(const Costs& cost) {
        std::size_t here = 0;
        for (std::size_t i = 1; i < kChoices; ++i) {
            here = cost[i * kChoices] < cost[here * kChoices] ? i : here;
        }
        std::size_t next = 0;
        for (std::size_t m = count_; m > 0; --m) {
            changed_[m] = duration_s_[m] != offered_s_[m][here] ? 1 : 0;
            duration_s_[m] = offered_s_[m][here];
            const std::size_t before = from_[m][here * kChoices + next];
            next = here;
            here = before;
        }
    }

    // What keeps step m from being shorter: its own limits, or of the ramps and corners that it
    // has a part in the one that is used most.
    [[nodiscard]] std::size_t limit_of(std::size_t m) const {
        if (duration_s_[m] <= least_s_[m] * (1.0 + kShares.back())) {
            return least_of_[m];
        }
        double worst = std::max(corner_ratio(m - 1), corner_ratio(m));
        std::size_t limit = kCorner;
        for (std::size_t n = std::max<std::size_t>(m - 1, 1); n <= std::min(m + 1, count_); ++n) {
            for (std::size_t a = 0; a < axes_; ++a) {
                const auto lane = static_cast<Eigen::Index>(a % kLanes);
                const std::size_t g = a / kLanes;
                const double ramps = ramps_s(n - 1, g)[lane] + ramps_s(n, g)[lane];
                if (0.5 * ramps / duration_s_[n] > worst) {
                    worst = 0.5 * ramps / duration_s_[n];
                    const double at_once = at_once_s(n - 1, g)[lane] + at_once_s(n, g)[lane];
                    limit =
                        ramps > 2.0 * at_once ? limit_index(Jerk, a) : limit_index(Acceleration, a);
                }
            }
        }
        return limit;
    }

    [[nodiscard]] std::vector<BindingLimit> binding() const {
        std::vector<LimitedStep> steps;
        for (std::size_t m = 1; m <= count_; ++m) {
            steps.push_back({step_[m], duration_s_[m], limit_of(m)});
        }
        return binding_limits(steps,
                              [&](std::size_t limit) { return limit_name(machine_, limit); });
    }

    const Machine& machine_;
    std::size_t axes_ = 0;
    std::size_t groups_ = 0;
    double corner_mm_ = kInfinity;
    double tick_s_ = 0.0;
    std::vector<Lanes> build_up_s_;  // acceleration over jerk
    std::vector<Lanes> cut_mm_s2_;   // a corner's cut over its ramp squared; 0 of rotary axes
    std::vector<Lanes> eye_mm_s2_;   // of the eye, corners x groups x 3; none without a limit
    bool limited_jerk_ = false;
    std::size_t count_ = 0;
    std::vector<std::size_t> step_;      // of the path
    std::vector<Lanes> move_;            // steps x groups, over acceleration
    std::vector<double> least_s_;        // for velocities and fibre
    std::vector<std::size_t> least_of_;  // and which of them
    std::vector<double> duration_s_;
    std::vector<char> changed_;  // in the last round
    std::vector<char> open_;
    std::vector<std::array<std::uint8_t, kPairs>> from_;  // choices of the step before
    std::vector<std::array<double, kChoices>> offered_s_;
};

}  // namespace

TimedPath time_path(const Machine& machine, std::span<const double> fibre_mm,
                    const JointPath& joints, const TimeLawOptions& options) {
    assert(fibre_mm.size() == joints.size() && options.corner_mm > 0.0);
    if (!(options.fibre_speed_mm_s > 0.0)) {
        throw InputError(
            "time.fibre_speed", "",
            "fibre speed is " + fixed(options.fibre_speed_mm_s, 3) + " mm/s; it must be above 0");
    }
    TimeLaw law(machine, joints, fibre_mm, options);
    law.sweep();
    law.slow_down();
    law.tighten();
    law.keep_ticks(options.tick_s);
    return law.result(joints.size());
}

}  // namespace meshwind
