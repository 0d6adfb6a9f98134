#include "postproc/time_law.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/error.h"
#include "core/text_number.h"
#include "core/units.h"

namespace meshwind {
namespace {

// Relative slack of the acceleration test, so that a step that was just lengthened counts as kept.
constexpr double kRatioSlack = 1e-6;

// Of a long and a short step the ramp takes half of the short one, and as long as all of it in the
// long one.
constexpr double kShorterShare = 1.5;

// A duration that is a whole number of ticks up to rounding is not one tick more.
constexpr double kWholeTick = 1e-6;

// Index of what sets a step's duration: 0 none, 1 fibre, then two per axis.
constexpr std::size_t kNoLimit = 0;
constexpr std::size_t kFibre = 1;
std::size_t velocity_of(std::size_t joint) {
    return 2 + 2 * joint;
}
std::size_t acceleration_of(std::size_t joint) {
    return 3 + 2 * joint;
}

std::string limit_name(const Machine& machine, std::size_t limit) {
    if (limit == kFibre) {
        return "fibre";
    }
    const char letter = machine.axis((limit - 2) / 2).letter;
    return std::string(1, letter) + (limit % 2 == 0 ? " velocity" : " acceleration");
}

class TimeLaw {
public:
    TimeLaw(const Machine& machine, const JointPath& joints, double tick_s)
        : machine_(machine),
          joints_(joints),
          tick_s_(tick_s),
          step_s_(joints.size(), 0.0),
          limit_(joints.size(), kNoLimit) {}

    TimeLaw(const Machine& machine, const JointPath& joints, std::span<const double> step_s)
        : machine_(machine), joints_(joints), step_s_(step_s.begin(), step_s.end()) {}

    void keep_velocities(std::span<const double> fibre_mm, double fibre_mm_s) {
        for (std::size_t i = 1; i < joints_.size(); ++i) {
            lengthen(i, fibre_mm[i] / fibre_mm_s, kFibre);
            for (std::size_t a = 0; a < joints_.axis_count; ++a) {
                lengthen(i, std::abs(move(i, a)) / machine_.axis(a).velocity, velocity_of(a));
            }
        }
    }

    // Slows down starts (towards larger indices), then stops; true when anything changed.
    bool sweep() {
        bool changed = false;
        std::size_t before = 0;
        for (std::size_t i = 1; i < joints_.size(); ++i) {
            changed = adapt(i, before) || changed;
            before = step_s_[i] > 0.0 ? i : before;
        }
        before = 0;
        for (std::size_t i = joints_.size(); i-- > 1;) {
            changed = adapt(i, before) || changed;
            before = step_s_[i] > 0.0 ? i : before;
        }
        return changed;
    }

    [[nodiscard]] AxisLoads loads() const {
        AxisLoads loads;
        const auto raise = [](AxisLoad& load, double ratio, std::size_t step, std::size_t joint) {
            load = ratio > load.ratio ? AxisLoad{ratio, step, joint} : load;
        };
        std::size_t before = 0;
        for (std::size_t i = 1; i < joints_.size(); ++i) {
            if (step_s_[i] <= 0.0) {
                continue;
            }
            for (std::size_t a = 0; a < joints_.axis_count; ++a) {
                raise(loads.velocity, std::abs(speed(i, a)) / machine_.axis(a).velocity, i, a);
                raise(loads.acceleration, ramp_ratio(i, before, a), i, a);
                raise(loads.acceleration, ramp_ratio(before, i, a), before, a);
            }
            before = i;
        }
        for (std::size_t a = 0; a < joints_.axis_count && before != 0; ++a) {
            raise(loads.acceleration, ramp_ratio(before, 0, a), before, a);
        }
        return loads;
    }

    // Time that the first moving step loses in its start, and the last in its stop.
    [[nodiscard]] double rest_ramps_s() const {
        std::size_t first = 0;
        std::size_t last = 0;
        for (std::size_t i = 1; i < joints_.size(); ++i) {
            if (step_s_[i] > 0.0) {
                first = first == 0 ? i : first;
                last = i;
            }
        }
        double start = 0.0;
        double stop = 0.0;
        for (std::size_t a = 0; a < joints_.axis_count && first != 0; ++a) {
            const double twice = 2.0 * machine_.axis(a).acceleration;
            start = std::max(start, std::abs(speed(first, a)) / twice);
            stop = std::max(stop, std::abs(speed(last, a)) / twice);
        }
        return start + stop;
    }

    TimedPath result() && {
        TimedPath timed;
        std::vector<double> time_s(2 + 2 * joints_.axis_count, 0.0);
        timed.ramp_s = rest_ramps_s();
        timed.duration_s = timed.ramp_s;
        for (std::size_t i = 0; i < step_s_.size(); ++i) {
            timed.duration_s += step_s_[i];
            time_s[limit_[i]] += step_s_[i];
        }
        for (std::size_t limit = kFibre; limit < time_s.size(); ++limit) {
            if (time_s[limit] > 0.0) {
                timed.binding.push_back({limit_name(machine_, limit), time_s[limit]});
            }
        }
        std::stable_sort(
            timed.binding.begin(), timed.binding.end(),
            [](const BindingLimit& a, const BindingLimit& b) { return a.time_s > b.time_s; });
        timed.worst_acceleration_ratio = loads().acceleration.ratio;
        timed.step_s = std::move(step_s_);
        return timed;
    }

private:
    [[nodiscard]] double move(std::size_t step, std::size_t joint) const {
        return joints_.row(step)[joint] - joints_.row(step - 1)[joint];
    }

    // Step 0 stands for rest, before the first step and after the last.
    [[nodiscard]] double speed(std::size_t step, std::size_t joint) const {
        return step == 0 ? 0.0 : move(step, joint) / step_s_[step];
    }

    // False where the step is already so long.
    bool lengthen(std::size_t step, double duration_s, std::size_t limit) {
        if (tick_s_ > 0.0) {
            duration_s = tick_s_ * std::ceil(duration_s / tick_s_ - kWholeTick);
        }
        if (duration_s <= step_s_[step]) {
            return false;
        }
        step_s_[step] = duration_s;
        limit_[step] = limit;
        return true;
    }

    // Ramp that `step` has with its neighbour over the time that it has for it; a neighbour 0 is
    // rest. In a reversal the step looks after its own side alone; beside an axis at rest it may.
    [[nodiscard]] double ramp_ratio(std::size_t step, std::size_t neighbour,
                                    std::size_t joint) const {
        if (step == 0) {
            return 0.0;
        }
        const double acceleration = machine_.axis(joint).acceleration;
        const double mine = speed(step, joint);
        const double other = speed(neighbour, joint);
        const double alone = 2.0 * std::abs(mine) / (acceleration * step_s_[step]);
        if (neighbour == 0) {
            return alone;
        }
        const double shared = std::abs(mine - other) /
                              (acceleration * ramp_room_s(step_s_[step], step_s_[neighbour]));
        if (mine == 0.0 || other == 0.0) {
            // What rests leaves the ramp to what moves, which may do it alone.
            return mine == 0.0 ? 0.0 : std::min(alone, shared);
        }
        return mine * other < 0.0 ? alone : shared;
    }

    static double ramp_room_s(double one_s, double other_s) {
        return std::min({0.5 * (one_s + other_s), kShorterShare * one_s, kShorterShare * other_s});
    }

    // Lengthens `step` until every axis that is faster in it than in the neighbour has time for its
    // ramp. A step that is slower but too short to ramp in is left to the sweep the other way,
    // which slows down the faster neighbour.
    bool adapt(std::size_t step, std::size_t neighbour) {
        if (step_s_[step] <= 0.0) {
            return false;
        }
        bool changed = false;
        for (std::size_t a = 0; a < joints_.axis_count; ++a) {
            const double mine = speed(step, a);
            const double other = speed(neighbour, a);
            if (std::abs(mine) < std::abs(other) && mine * other >= 0.0) {
                continue;
            }
            if (ramp_ratio(step, neighbour, a) <= 1.0 + kRatioSlack) {
                continue;
            }
            const double acceleration = machine_.axis(a).acceleration;
            const double alone = std::sqrt(2.0 * std::abs(move(step, a)) / acceleration);
            double duration = alone;
            if (neighbour != 0 && mine * other >= 0.0) {
                const double shared = shortest(std::abs(move(step, a)), std::abs(other),
                                               step_s_[neighbour], acceleration);
                duration = other == 0.0 ? std::min(alone, shared) : shared;
            }
            changed = lengthen(step, duration, acceleration_of(a)) || changed;
        }
        return changed;
    }

    // Duration T of a step of length `move` beside a slower neighbour of speed v and duration T_n:
    // move/T - v = acceleration * ramp room, which is the least of three straight lines in T.
    static double shortest(double move, double v, double neighbour_s, double acceleration) {
        const auto solve = [&](double slope, double room_s) {
            const double p = acceleration * room_s + v;
            return 2.0 * move / (p + std::sqrt(p * p + 4.0 * acceleration * slope * move));
        };
        return std::max({solve(0.5, 0.5 * neighbour_s), solve(kShorterShare, 0.0),
                         solve(0.0, kShorterShare * neighbour_s)});
    }

    const Machine& machine_;
    const JointPath& joints_;
    double tick_s_ = 0.0;
    std::vector<double> step_s_;
    std::vector<std::size_t> limit_;
};

}  // namespace

TimedPath time_path(const Machine& machine, std::span<const double> fibre_mm,
                    const JointPath& joints, const TimeLawOptions& options) {
    assert(fibre_mm.size() == joints.size());
    if (!(options.fibre_speed_mm_s > 0.0)) {
        std::string value;
        append_shortest(value, options.fibre_speed_mm_s);
        throw InputError("time.fibre_speed", "",
                         "fibre speed is " + value + " mm/s; it must be above 0");
    }
    TimeLaw law(machine, joints, options.tick_s);
    law.keep_velocities(fibre_mm, std::min(options.fibre_speed_mm_s, machine.fibre.max_speed_mm_s));
    for (int i = 0; i < options.acceleration_sweeps; ++i) {
        if (!law.sweep()) {
            break;
        }
    }
    return std::move(law).result();
}

std::vector<double> fibre_moved_mm(const EyePath& path) {
    std::vector<double> fibre_mm(path.size(), 0.0);
    for (std::size_t i = 1; i < path.size(); ++i) {
        const double laid = path[i].s_mm - path[i - 1].s_mm;
        const double longer = path[i].free_length_mm - path[i - 1].free_length_mm;
        fibre_mm[i] = std::max(std::abs(laid), std::abs(laid + longer));
    }
    return fibre_mm;
}

AxisLoads axis_loads(const Machine& machine, const JointPath& joints,
                     std::span<const double> step_s) {
    assert(step_s.size() == joints.size());
    return TimeLaw(machine, joints, step_s).loads();
}

}  // namespace meshwind
