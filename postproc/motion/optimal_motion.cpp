#include "postproc/motion/optimal_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "core/units.h"
#include "machines/eye_inverse.h"
#include "postproc/motion/joint_path.h"
#include "postproc/motion/motion_knots.h"

namespace meshwind {
namespace {

constexpr std::size_t kChunk = 256;

// Places that a change asks for are no nearer to the one before: the motion would have to be smooth
// over nothing.
constexpr double kMinKnot_mm = 1.0;

// Places kept at either end of a stretch: what the accelerations at its first free one need.
constexpr double kKeptEnds = 3.0;

// Where a motion is to be mended, what is clear is looked for in such steps to either side.
constexpr int kSearchSteps = 10;
constexpr double kSearchTurn_rad = 0.05;
constexpr double kSearchLength_mm = 4.0;

// The natural cubic spline through values at ascending places (n >= 2).
class Spline {
public:
    Spline(std::span<const double> at, std::vector<double> value)
        : at_(at), value_(std::move(value)), bend_(value_.size(), 0.0) {
        // Thomas' algorithm for the second derivatives, zero at both ends.
        const std::size_t n = value_.size();
        std::vector<double> upper(n, 0.0);
        for (std::size_t i = 1; i + 1 < n; ++i) {
            const double before = at_[i] - at_[i - 1];
            const double after = at_[i + 1] - at_[i];
            const double right =
                6.0 * ((value_[i + 1] - value_[i]) / after - (value_[i] - value_[i - 1]) / before);
            const double pivot = 2.0 * (before + after) - before * upper[i - 1];
            upper[i] = after / pivot;
            bend_[i] = (right - before * bend_[i - 1]) / pivot;
        }
        for (std::size_t i = n - 1; i-- > 1;) {
            bend_[i] -= upper[i] * bend_[i + 1];
        }
    }

    // Between places `i` and `i + 1`.
    [[nodiscard]] double operator()(std::size_t i, double place) const {
        const double width = at_[i + 1] - at_[i];
        const double b = (place - at_[i]) / width;
        const double a = 1.0 - b;
        return a * value_[i] + b * value_[i + 1] +
               ((a * a * a - a) * bend_[i] + (b * b * b - b) * bend_[i + 1]) * width * width / 6.0;
    }

private:
    std::span<const double> at_;
    std::vector<double> value_;
    std::vector<double> bend_;
};

// Lengths that change no faster than they may, none shorter than wished for.
void keep_rates(EyePath& path) {
    for (std::size_t i = 1; i < path.size(); ++i) {
        const double ds = path[i].s_mm - path[i - 1].s_mm;
        path[i].free_length_mm =
            std::max(path[i].free_length_mm, path[i - 1].free_length_mm - kShorteningRate * ds);
    }
    for (std::size_t i = path.size(); i-- > 1;) {
        const double ds = path[i].s_mm - path[i - 1].s_mm;
        path[i - 1].free_length_mm =
            std::max(path[i - 1].free_length_mm, path[i].free_length_mm - kLengtheningRate * ds);
    }
}

// Kept stations beside free ones are places, so that no more than these is moved.
bool is_edge(const OptimalMotionTask& task, std::size_t station) {
    if (task.free.empty() || task.free[station] != 0) {
        return false;
    }
    return (station > 0 && task.free[station - 1] != 0) ||
           (station + 1 < task.free.size() && task.free[station + 1] != 0);
}

// The choice nearest to the given one that is clear, or that one.
KnotChoice clear_choice(const MotionKnots& knots, std::size_t k) {
    const KnotChoice given = knots[k].given;
    if (knots[k].kept || knots.clear(k, given)) {
        return given;
    }
    KnotChoice best = given;
    double nearest = std::numeric_limits<double>::infinity();
    for (int turn = -kSearchSteps; turn <= kSearchSteps; ++turn) {
        for (int length = -kSearchSteps; length <= kSearchSteps; ++length) {
            const double distance = std::hypot(turn, length);
            const KnotChoice choice{given.turn_rad + turn * kSearchTurn_rad,
                                    given.length_mm + length * kSearchLength_mm};
            if (distance < nearest && knots.clear(k, choice)) {
                nearest = distance;
                best = choice;
            }
        }
    }
    return best;
}

std::vector<KnotChoice> clear_choices(const MotionKnots& knots) {
    std::vector<KnotChoice> choices(knots.size());
    parallel_for(knots.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            choices[k] = clear_choice(knots, k);
        }
    });
    return choices;
}

}  // namespace

MotionKnots::MotionKnots(const OptimalMotionTask& task, std::size_t first, std::size_t last)
    : task_(task), inverse_(make_eye_inverse(task.machine)) {
    const EyePath& path = task.path;
    for (std::size_t i = first; i <= last; ++i) {
        if (!knots_.empty()) {
            const double passed = path[i].s_mm - path[knots_.back().station].s_mm;
            const bool needed = i == last ? passed > 0.0 : is_edge(task, i) && passed > kMinKnot_mm;
            if (passed < task.knot_mm && !needed) {
                continue;
            }
            knots_.back().ahead_mm = passed;
        }
        Knot knot;
        knot.station = i;
        knot.kept = !task.free.empty() && task.free[i] == 0;
        knot.given = {path[i].turn_rad, path[i].free_length_mm};
        knots_.push_back(knot);
    }
    parallel_for(knots_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const EyePoint& at = point(k);
            knots_[k].longest_mm =
                unobstructed_mm(task_.obstacles, at.landing_mm,
                                at.tangent.cross(at.binormal).normalized(), at.tangent, task_.rule);
        }
    });
    find_joints();
}

void MotionKnots::find_joints() {
    if (!inverse_->has_branches()) {
        joints_.assign(axis_count(), 0.0);
        return;
    }
    EyePath given;
    std::vector<double> turns_rad;
    for (std::size_t k = 0; k < size(); ++k) {
        given.push_back(point(k));
        turns_rad.push_back(knots_[k].given.turn_rad);
    }
    joints_ = solve_joints(task_.machine, given, turns_rad).joints;
}

double MotionKnots::least_mm(std::size_t knot) const {
    return task_.rule.min_mm + task_.ahead_mm[knots_[knot].station];
}

double MotionKnots::central_rad(std::size_t knot, double length_mm, double near_rad) const {
    const Eigen::Vector3d eye = eye_mm(knot, length_mm);
    if (std::hypot(eye.x(), eye.y()) < kMinEyeRadius_mm) {
        return near_rad;
    }
    const double central = -std::atan2(eye.y(), eye.x());
    return near_rad + std::remainder(central - near_rad, 2.0 * kPi);
}

void MotionKnots::joints(std::size_t knot, const KnotChoice& choice,
                         std::span<const double> previous, std::span<double> joints) const {
    const EyePoint& at = point(knot);
    (void)inverse_->solve(
        {.eye_mm = eye_mm(knot, choice.length_mm), .tangent = at.tangent, .binormal = at.binormal},
        choice.turn_rad, previous, joints);
}

bool MotionKnots::head_clear(std::size_t station, const KnotChoice& choice) const {
    const EyePoint& at = task_.path[station];
    const Eigen::Vector3d eye = at.landing_mm + choice.length_mm * at.tangent;
    const auto outward = [&] {
        return Eigen::Vector3d(std::cos(choice.turn_rad), -std::sin(choice.turn_rad), 0.0);
    };
    return is_head_clear(task_.obstacles, task_.rule, eye,
                         task_.rule.arm.empty() ? Eigen::Vector3d::UnitX() : outward(),
                         task_.more_mm[station]);
}

// Whether an arm reaches the place from near where it is in the given motion.
bool MotionKnots::in_reach(std::size_t knot, const KnotChoice& choice) const {
    if (!inverse_->has_branches()) {
        return true;
    }
    std::vector<double> joints(axis_count());
    const EyePoint& at = point(knot);
    const WristState state = inverse_->solve(
        {.eye_mm = eye_mm(knot, choice.length_mm), .tangent = at.tangent, .binormal = at.binormal},
        choice.turn_rad, given_joints(knot), joints);
    if (state.residual_mm > kEyeThere_mm) {
        return false;
    }
    for (std::size_t a = 0; a < joints.size(); ++a) {
        if (joints[a] < axis(a).min || joints[a] > axis(a).max) {
            return false;
        }
    }
    return true;
}

bool MotionKnots::clear(std::size_t knot, const KnotChoice& choice) const {
    return choice.length_mm >= least_mm(knot) && choice.length_mm <= knots_[knot].longest_mm &&
           head_clear(knots_[knot].station, choice) && in_reach(knot, choice);
}

bool MotionKnots::clear_between(std::size_t knot, const KnotChoice& from,
                                const KnotChoice& to) const {
    const double start = point(knot).s_mm;
    for (std::size_t i = knots_[knot].station + 1; i < knots_[knot + 1].station; ++i) {
        const double share = (task_.path[i].s_mm - start) / knots_[knot].ahead_mm;
        if (!head_clear(i, {from.turn_rad + share * (to.turn_rad - from.turn_rad),
                            from.length_mm + share * (to.length_mm - from.length_mm)})) {
            return false;
        }
    }
    return true;
}

namespace {

// A stretch of the path with a motion of its own; the first and the last places of it are kept.
void move_stretch(const OptimalMotionTask& task, std::size_t first, std::size_t last,
                  EyePath& path) {
    const MotionKnots knots(task, first, last);
    if (knots.size() < 3) {
        return;
    }
    std::vector<KnotChoice> choices =
        task.from_given ? clear_choices(knots) : choose_on_grid(knots);
    if (choices.empty()) {
        return;
    }
    choices = smooth_motion(knots, std::move(choices));
    std::vector<double> at;
    std::vector<double> turn;
    std::vector<double> length;
    for (std::size_t k = 0; k < knots.size(); ++k) {
        at.push_back(knots.point(k).s_mm);
        turn.push_back(choices[k].turn_rad);
        length.push_back(choices[k].length_mm);
    }
    const Spline turn_at(at, turn);
    const Spline length_at(at, length);
    // Behind a stretch the mandrel may have turned more often than before.
    const double before_rad = path[first].turn_rad - task.path[first].turn_rad;
    const double whole_rad = turn.back() - task.path[last].turn_rad;
    std::size_t k = 0;
    for (std::size_t i = first; i <= last; ++i) {
        EyePoint& point = path[i];
        while (k + 2 < knots.size() && knots[k + 1].station <= i) {
            ++k;
        }
        if (knots[k].kept && knots[k + 1].kept) {
            point.turn_rad += turn[k] - knots[k].given.turn_rad;
            continue;
        }
        point.turn_rad = before_rad + turn_at(k, point.s_mm);
        if (!task.fixed_lengths) {
            point.free_length_mm =
                std::max(task.rule.min_mm + task.ahead_mm[i], length_at(k, point.s_mm));
        }
    }
    for (std::size_t i = last + 1; i < path.size(); ++i) {
        path[i].turn_rad += whole_rad;
    }
}

struct Stretch {
    std::size_t first = 0;
    std::size_t last = 0;
};

// Runs of free stations with some fibre that is kept to either side.
std::vector<Stretch> stretches_of(const OptimalMotionTask& task) {
    const EyePath& path = task.path;
    if (task.free.empty()) {
        return {{0, path.size() - 1}};
    }
    std::vector<Stretch> stretches;
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (task.free[i] == 0) {
            continue;
        }
        Stretch run{i, i};
        while (run.first > 0 && path[i].s_mm - path[run.first].s_mm < kKeptEnds * task.knot_mm) {
            --run.first;
        }
        while (i + 1 < path.size() && task.free[i + 1] != 0) {
            ++i;
        }
        run.last = i;
        while (run.last + 1 < path.size() &&
               path[run.last].s_mm - path[i].s_mm < kKeptEnds * task.knot_mm) {
            ++run.last;
        }
        if (!stretches.empty() && stretches.back().last >= run.first) {
            stretches.back().last = run.last;
        } else {
            stretches.push_back(run);
        }
    }
    return stretches;
}

}  // namespace

EyePath optimal_motion(const OptimalMotionTask& task) {
    EyePath path = task.path;
    if (path.empty()) {
        return path;
    }
    for (const Stretch& stretch : stretches_of(task)) {
        move_stretch(task, stretch.first, stretch.last, path);
    }
    if (!task.fixed_lengths) {
        keep_rates(path);
    }
    for (EyePoint& point : path) {
        point.eye_mm = point.landing_mm + point.free_length_mm * point.tangent;
    }
    return path;
}

}  // namespace meshwind
