#include "postproc/motion/time_law.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <Eigen/Core>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/text/text_number.h"
#include "postproc/motion/duration_choice.h"
#include "postproc/motion/moving_steps.h"

namespace meshwind {
namespace {

// Sweeps over the path, at most; a step is lengthened by no less than a part of this many.
constexpr int kMaxSweeps = 200;
constexpr double kSweepSlack = 1e-4;

// A duration that is a whole number of ticks up to rounding is not one tick more.
constexpr double kWholeTick = 1e-6;

// Any duration will do.
constexpr double kNoTick_s = 0.0;

// Keeps 0/0 of an axis at rest apart.
constexpr double kLeast_s = 1e-300;

// Slowing down lengthens a step without room by the square root of what it lacks, within these, so
// that it neither creeps nor overshoots by much.
constexpr double kMinSlowing = 1.001;
constexpr double kMaxSlowing = 1.3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string limit_name(const Machine& machine, std::size_t limit) {
    if (limit == kFibreLimit || limit == kCornerLimit) {
        return limit == kFibreLimit ? "fibre" : "corner";
    }
    const char* const kinds[] = {" velocity", " acceleration", " jerk"};
    return std::string(1, machine.axis((limit - 2) / 3).letter) + kinds[(limit - 2) % 3];
}

// Least duration in which step m can ramp from the velocity of a neighbour, with half of both for a
// ramp. Axes that are slower than there ask for none: the neighbour is the one to be lengthened.
double least_beside_s(const MovingSteps& steps, std::span<const double> duration_s, std::size_t m,
                      std::size_t neighbour) {
    const bool rests = neighbour == 0 || neighbour > steps.count;
    const double room_s = rests ? kInfinity : duration_s[neighbour];
    double longest_s = 0.0;
    for (std::size_t g = 0; g < steps.groups; ++g) {
        const AxisLanes move = steps.move[m * steps.groups + g];
        const AxisLanes size = move.abs();
        const AxisLanes other = steps.move[neighbour * steps.groups + g] / duration_s[neighbour];
        const AxisLanes v = other.abs();
        // Both sides of a reversal have half of the ramp to themselves.
        const AxisLanes alone = (2.0 * size).sqrt().max(2.0 * size / room_s);
        const AxisLanes shared = (2.0 * size / (v + (v.square() + 4.0 * size).sqrt()).max(kLeast_s))
                                     .max(size / (v + room_s));
        const AxisLanes faster = (size > v * duration_s[m]).select(shared, 0.0);
        longest_s = std::max(longest_s, (move * other < 0.0).select(alone, faster).maxCoeff());
    }
    return longest_s;
}

// Makes each step long enough to ramp up from the one before it, and down to the one after, in
// sweeps along the path and back.
std::vector<double> swept_s(const MovingSteps& steps, std::vector<double> duration_s) {
    std::vector<char> up(steps.count + 2, 1);  // to be looked at: it or its neighbour has changed
    std::vector<char> down = up;
    const auto visit = [&](std::vector<char>& open, std::size_t m, std::size_t neighbour) {
        if (open[m] == 0) {
            return false;
        }
        open[m] = 0;
        const double least_s = least_beside_s(steps, duration_s, m, neighbour);
        const bool longer = least_s > duration_s[m] * (1.0 + kSweepSlack);
        if (longer) {
            duration_s[m] = least_s;
            up[m] = up[m + 1] = down[m] = down[m - 1] = 1;
        }
        return longer;
    };
    bool changed = true;
    for (int sweeps = 0; changed && sweeps < kMaxSweeps; ++sweeps) {
        check_interrupt();
        changed = false;
        for (std::size_t m = 1; m <= steps.count; ++m) {
            changed = visit(up, m, m - 1) || changed;
        }
        for (std::size_t m = steps.count; m > 0; --m) {
            changed = visit(down, m, m + 1) || changed;
        }
    }
    return duration_s;
}

// The next whole number of ticks.
double in_ticks_s(double duration_s, double tick_s) {
    return tick_s > 0.0 ? tick_s * std::ceil(duration_s / tick_s - kWholeTick) : duration_s;
}

// Lengthens what still has no room for its ramps or cuts a corner too far, with its neighbours. It
// ends, for what is long enough always has.
std::vector<double> slowed_down_s(const MovingSteps& steps, std::vector<double> duration_s,
                                  double tick_s) {
    std::vector<char> open(steps.count + 4, 1);  // at 1 + m: to be looked at
    const auto lengthen = [&](std::size_t m, double factor) {
        duration_s[m] = in_ticks_s(duration_s[m] * factor, tick_s);
    };
    for (bool changed = true; changed;) {
        check_interrupt();
        changed = false;
        for (std::size_t m = 1; m <= steps.count; ++m) {
            if (open[1 + m] == 0) {
                continue;
            }
            open[1 + m] = 0;
            const double lacks = std::max(room_ratio(steps, duration_s, m),
                                          std::sqrt(corner_ratio(steps, duration_s, m)));
            if (lacks > 1.0 + kStepSlack) {
                const double longer = std::clamp(std::sqrt(lacks), kMinSlowing, kMaxSlowing);
                lengthen(m, longer);
                if (m > 1) {
                    lengthen(m - 1, std::sqrt(longer));
                }
                if (m < steps.count) {
                    lengthen(m + 1, std::sqrt(longer));
                }
                std::fill_n(open.begin() + static_cast<std::ptrdiff_t>(m) - 1, 5, 1);
                changed = true;
            }
        }
    }
    return duration_s;
}

// Durations of whole ticks, none shorter than it was; without a tick as they are.
std::vector<double> kept_in_ticks_s(const MovingSteps& steps, std::vector<double> duration_s,
                                    double tick_s) {
    for (std::size_t m = 1; m <= steps.count; ++m) {
        duration_s[m] = in_ticks_s(duration_s[m], tick_s);
    }
    return slowed_down_s(steps, std::move(duration_s), tick_s);
}

// The limit that keeps step m from being shorter: its own, or of the ramps and corners that it has
// a part in the one that is used most.
std::size_t limit_of(const MovingSteps& steps, std::span<const double> duration_s, std::size_t m) {
    if (duration_s[m] <= steps.least_s[m] * (1.0 + kMinDurationShare)) {
        return steps.least_of[m];
    }
    const auto at_once_s = [&](std::size_t n, std::size_t g, Eigen::Index lane) {
        return std::abs(velocity_change_s(steps, duration_s, n, g)[lane]);
    };
    double worst =
        std::max(corner_ratio(steps, duration_s, m - 1), corner_ratio(steps, duration_s, m));
    std::size_t limit = kCornerLimit;
    for (std::size_t n = std::max<std::size_t>(m - 1, 1); n <= std::min(m + 1, steps.count); ++n) {
        for (std::size_t a = 0; a < steps.axes; ++a) {
            const auto lane = static_cast<Eigen::Index>(a % kAxisLanes);
            const std::size_t g = a / kAxisLanes;
            const double ramps = corner_ramps_s(steps, duration_s, n - 1, g)[lane] +
                                 corner_ramps_s(steps, duration_s, n, g)[lane];
            if (0.5 * ramps / duration_s[n] > worst) {
                worst = 0.5 * ramps / duration_s[n];
                const double at_once = at_once_s(n - 1, g, lane) + at_once_s(n, g, lane);
                limit = limit_index(
                    ramps > 2.0 * at_once ? AxisLimit::Jerk : AxisLimit::Acceleration, a);
            }
        }
    }
    return limit;
}

std::vector<BindingLimit> binding(const Machine& machine, const MovingSteps& steps,
                                  std::span<const double> duration_s) {
    std::vector<LimitedStep> limited;
    for (std::size_t m = 1; m <= steps.count; ++m) {
        limited.push_back({steps.step[m], duration_s[m], limit_of(steps, duration_s, m)});
    }
    return binding_limits(limited, [&](std::size_t limit) { return limit_name(machine, limit); });
}

TimedPath timed_path(const Machine& machine, const MovingSteps& steps,
                     std::span<const double> duration_s, std::size_t points) {
    TimedPath timed;
    timed.step_s.assign(points, 0.0);
    for (std::size_t m = 1; m <= steps.count; ++m) {
        timed.step_s[steps.step[m]] = duration_s[m];
    }
    timed.ramp_s = steps.count > 0 ? 0.5 * (longest_ramp_s(steps, duration_s, 0) +
                                            longest_ramp_s(steps, duration_s, steps.count))
                                   : 0.0;
    timed.duration_s = timed.ramp_s;
    for (const double step_s : timed.step_s) {
        timed.duration_s += step_s;
    }
    timed.binding = binding(machine, steps, duration_s);
    return timed;
}

}  // namespace

TimedPath time_path(const Machine& machine, std::span<const double> fibre_mm,
                    const JointPath& joints, const TimeLawOptions& options) {
    assert(fibre_mm.size() == joints.size() && options.corner_mm > 0.0);
    if (!(options.fibre_speed_mm_s > 0.0)) {
        throw InputError(
            "time.fibre_speed", "",
            "fibre speed is " + fixed(options.fibre_speed_mm_s, 3) + " mm/s; it must be above 0");
    }
    const MovingSteps steps = moving_steps(machine, joints, fibre_mm, options);
    std::vector<double> duration_s = swept_s(steps, steps.least_s);
    duration_s = slowed_down_s(steps, std::move(duration_s), kNoTick_s);
    duration_s = tightened_s(steps, std::move(duration_s));
    duration_s = kept_in_ticks_s(steps, std::move(duration_s), options.tick_s);
    return timed_path(machine, steps, duration_s, joints.size());
}

}  // namespace meshwind
