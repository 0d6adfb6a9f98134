#include "postproc/time_law.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/error.h"
#include "core/text_number.h"

namespace meshwind {
namespace {

// Relative slack of the acceleration test, so that a step that was just lengthened counts as kept.
constexpr double kRatioSlack = 1e-6;

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
    TimeLaw(const Machine& machine, const JointPath& joints)
        : machine_(machine),
          joints_(joints),
          step_s_(joints.size(), 0.0),
          limit_(joints.size(), kNoLimit) {}

    void keep_velocities(const EyePath& path, double fibre_mm_s) {
        for (std::size_t i = 1; i < joints_.size(); ++i) {
            const double laid = std::abs(path[i].s_mm - path[i - 1].s_mm);
            const double paid = std::abs(path[i].s_mm - path[i - 1].s_mm + path[i].free_length_mm -
                                         path[i - 1].free_length_mm);
            lengthen(i, std::max(laid, paid) / fibre_mm_s, kFibre);
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

    [[nodiscard]] double worst_ratio() const {
        double worst = 0.0;
        std::size_t before = 0;
        for (std::size_t i = 1; i <= joints_.size(); ++i) {
            const std::size_t step = i < joints_.size() ? i : 0;
            if (step != 0 && step_s_[step] <= 0.0) {
                continue;
            }
            for (std::size_t a = 0; a < joints_.axis_count; ++a) {
                const double allowed =
                    0.5 * machine_.axis(a).acceleration * (step_s_[step] + step_s_[before]);
                const double change = std::abs(speed(step, a) - speed(before, a));
                worst = allowed > 0.0 ? std::max(worst, change / allowed) : worst;
            }
            before = step;
        }
        return worst;
    }

    TimedPath result() && {
        TimedPath timed;
        std::vector<double> time_s(2 + 2 * joints_.axis_count, 0.0);
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
        timed.worst_acceleration_ratio = worst_ratio();
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

    void lengthen(std::size_t step, double duration_s, std::size_t limit) {
        if (duration_s > step_s_[step]) {
            step_s_[step] = duration_s;
            limit_[step] = limit;
        }
    }

    // Lengthens `step` until no axis gains more speed than it may, coming from `neighbour`.
    bool adapt(std::size_t step, std::size_t neighbour) {
        if (step_s_[step] <= 0.0) {
            return false;
        }
        bool changed = false;
        for (std::size_t a = 0; a < joints_.axis_count; ++a) {
            const double mine = move(step, a);
            const double other = speed(neighbour, a);
            const double half = 0.5 * machine_.axis(a).acceleration;
            const double neighbour_s = neighbour == 0 ? 0.0 : step_s_[neighbour];
            const double own_s = step_s_[step];
            const bool faster = std::abs(mine) >= std::abs(other) * own_s;
            const double change = std::abs(mine / own_s - other);
            if (!faster || change <= half * (own_s + neighbour_s) * (1.0 + kRatioSlack)) {
                continue;
            }
            const double duration =
                shortest(std::abs(mine), mine > 0.0 ? other : -other, neighbour_s, half);
            if (duration > own_s) {
                lengthen(step, duration, acceleration_of(a));
                changed = true;
            }
        }
        return changed;
    }

    // Duration T of a step of length `move` whose neighbour has speed v along it and duration T_n:
    // move/T - v = half (T + T_n), that is half T^2 + (half T_n + v) T - move = 0. In a reversal
    // (v < 0) each side brakes within its own half, else the first one to be looked at would have
    // to wait for a neighbour that is still to be slowed down.
    static double shortest(double move, double v, double neighbour_s, double half) {
        if (v < 0.0) {
            return std::sqrt(move / half);
        }
        const double p = half * neighbour_s + v;
        return 2.0 * move / (p + std::sqrt(p * p + 4.0 * half * move));
    }

    const Machine& machine_;
    const JointPath& joints_;
    std::vector<double> step_s_;
    std::vector<std::size_t> limit_;
};

}  // namespace

TimedPath time_path(const Machine& machine, const EyePath& path, const JointPath& joints,
                    const TimeLawOptions& options) {
    assert(path.size() == joints.size());
    if (!(options.fibre_speed_mm_s > 0.0)) {
        std::string value;
        append_shortest(value, options.fibre_speed_mm_s);
        throw InputError("time.fibre_speed", "",
                         "fibre speed is " + value + " mm/s; it must be above 0");
    }
    TimeLaw law(machine, joints);
    law.keep_velocities(path, std::min(options.fibre_speed_mm_s, machine.fibre.max_speed_mm_s));
    for (int i = 0; i < options.acceleration_sweeps; ++i) {
        if (!law.sweep()) {
            break;
        }
    }
    return std::move(law).result();
}

double largest_take_back_mm(const EyePath& path) {
    double most = path.empty() ? 0.0 : path.front().s_mm + path.front().free_length_mm;
    double largest = 0.0;
    for (const EyePoint& point : path) {
        const double paid = point.s_mm + point.free_length_mm;
        most = std::max(most, paid);
        largest = std::max(largest, most - paid);
    }
    return largest;
}

}  // namespace meshwind
