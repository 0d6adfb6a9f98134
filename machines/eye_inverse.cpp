#include "machines/eye_inverse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/error.h"
#include "core/small_linear.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "machines/arm_eye_inverse.h"
#include "machines/arm_inverse.h"
#include "machines/damped_least_squares.h"
#include "machines/drawn_starts.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Iterations end well within the 1e-9 mm and 1e-9 rad that are promised.
constexpr double kGoal_mm = 1e-11;
constexpr double kGoal_rad = 1e-11;
constexpr double kReached_mm = 1e-9;
constexpr double kReached_rad = 1e-9;
constexpr int kMaxIterations = 200;
// Further starts where the previous joints lead to no solution.
constexpr int kStarts = 12;
constexpr double kDrawn_mm = 1000.0;
constexpr double kStep_rad = 0.5;
constexpr double kStep_mm = 500.0;
constexpr double kMinLength_mm = 100.0;
constexpr double kParallel = 1e-9;
constexpr double kPointTolerance_mm = 1e-9;
constexpr double kFlip_rad = 0.5 * kPi;
constexpr std::size_t kConstraints = 6;  // place, and the roller's three components

double length_of(const Machine& machine) {
    double length = kMinLength_mm;
    for (std::size_t j = 0; j < machine.axis_count(); ++j) {
        const Axis& axis = machine.axis(j);
        if (axis.type == AxisType::Rotary) {
            const Vector3d arm = machine.eye.position_mm - axis.point_mm;
            length = std::max(length, arm.cross(axis.direction).norm());
        }
    }
    return length;
}

// A point and a direction as the mandrel and as the eye carry them, base frame.
struct Carried {
    Vector3d point;
    Vector3d direction;
};

// How a unit of each axis moves the eye and its roller away from what the mandrel carries.
std::vector<Carried> motions(const Machine& machine, const std::vector<double>& joints,
                             const Carried& by_mandrel, const Carried& by_eye) {
    std::vector<Carried> result;
    const std::vector<PlacedAxis> placed = placed_axes(machine, joints);
    for (std::size_t j = 0; j < placed.size(); ++j) {
        const bool mandrel = j < machine.mandrel_chain.size();
        const double sign = mandrel ? -1.0 : 1.0;
        const Carried& carried = mandrel ? by_mandrel : by_eye;
        const Vector3d& d = placed[j].direction;
        if (placed[j].type == AxisType::Linear) {
            result.push_back({sign * d, Vector3d::Zero()});
        } else {
            result.push_back({sign * d.cross(carried.point - placed[j].point_mm),
                              sign * d.cross(carried.direction)});
        }
    }
    return result;
}

double angle_between_lines(const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

// Bounds and steps of the axes from `first` on, without their residuals.
LeastSquaresProblem problem_of_axes(const Machine& machine, std::size_t first, bool keep_limits) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    LeastSquaresProblem problem;
    problem.residuals = kConstraints;
    for (std::size_t j = first; j < machine.axis_count(); ++j) {
        const Axis& axis = machine.axis(j);
        problem.min.push_back(keep_limits ? axis.min : -kInfinity);
        problem.max.push_back(keep_limits ? axis.max : kInfinity);
        problem.max_step.push_back(axis.type == AxisType::Rotary ? kStep_rad : kStep_mm);
    }
    return problem;
}

// Turns rotary axes from `first` on by full turns, to where they are nearest to where they were
// before; those within their limits only where they stay there.
void turn_near(const Machine& machine, std::size_t first, std::span<const double> previous,
               std::vector<double>& joints) {
    for (std::size_t j = first; j < machine.axis_count(); ++j) {
        const Axis& axis = machine.axis(j);
        if (axis.type == AxisType::Rotary) {
            const double nearest =
                joints[j] + 2.0 * kPi * std::round((previous[j] - joints[j]) / (2.0 * kPi));
            const bool inside = joints[j] >= axis.min && joints[j] <= axis.max;
            joints[j] =
                !inside || (nearest >= axis.min && nearest <= axis.max) ? nearest : joints[j];
        }
    }
}

std::string count_words(std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string spindle_words(const SpindleWristInverse& inverse) {
    const std::string wrist = inverse.has_swing()  ? ", head roll and swing"
                              : inverse.has_roll() ? ", head roll"
                                                   : ", head that does not turn";
    return "spindle, " + count_words(inverse.linear_axes(), "linear axis", "linear axes") + wrist +
           ": closed form";
}

std::string general_words(const Machine& machine) {
    std::string words =
        count_words(machine.mandrel_chain.size(), "axis moves", "axes move") + " the mandrel, ";
    words += machine.eye_chain.empty() ? "the eye stands still"
                                       : std::to_string(machine.eye_chain.size()) + " the eye";
    if (ArmInverse::recognise(machine)) {
        return "arm: " + words + ": closed form for poses of the mandrel";
    }
    return "general chain: " + words + ": numerical";
}

struct Judged {
    MachineClass what;
    std::string code;
};

// Where a carriage along the spindle is the only linear axis; 0: none, or the eye is on the axis.
double kept_distance_mm(const Machine& machine, const SpindleWristInverse& inverse) {
    const Vector3d& carriage = machine.eye_chain.front().direction;
    const double distance_mm = machine.eye.position_mm.head<2>().norm();
    const bool along = carriage.cross(Vector3d::UnitZ()).norm() < kParallel;
    return inverse.linear_axes() == 1 && along && distance_mm > kPointTolerance_mm ? distance_mm
                                                                                   : 0.0;
}

Judged judge(const Machine& machine) {
    Judged judged;
    judged.what.spindle = spindle_sign(machine).has_value();
    if (const auto arm = ArmEyeInverse::recognise(machine)) {
        judged.what.arm = true;
        judged.what.free_turn = true;
        judged.what.words = std::string("spindle, arm that holds the eye") +
                            (arm->on_track() ? ", on a track" : "") + ": closed form";
        return judged;
    }
    try {
        const SpindleWristInverse inverse(machine);
        judged.what.closed_form = true;
        judged.what.free_turn = inverse.linear_axes() == 3;
        judged.what.words = spindle_words(inverse);
        if (!inverse.reaches_all()) {
            judged.what.eye_distance_mm = kept_distance_mm(machine, inverse);
            if (judged.what.eye_distance_mm == 0.0) {
                judged.code = "machine.missing_axis";
                judged.what.refusal =
                    "the linear axes do not bring the eye to every height and distance; the main "
                    "job needs a carriage along the spindle and a cross feed towards it, or an eye "
                    "that a carriage alone keeps at one distance from the spindle axis";
            }
        }
    } catch (const InputError& error) {
        judged.what.words = general_words(machine);
        judged.code = error.code();
        // The place is told by who asks.
        judged.what.refusal = std::string(error.what()).substr(error.place().size() + 2);
    }
    return judged;
}

}  // namespace

MachineClass machine_class(const Machine& machine) {
    return judge(machine).what;
}

void require_main_job(const Machine& machine, double eye_distance_mm) {
    const Judged judged = judge(machine);
    if (!judged.what.refusal.empty()) {
        throw InputError(judged.code, machine.name, judged.what.refusal);
    }
    const double kept_mm = judged.what.eye_distance_mm;
    if (kept_mm > 0.0 && std::abs(eye_distance_mm - kept_mm) > kReached_mm) {
        throw InputError("machine.missing_axis", machine.name,
                         "a carriage alone keeps the eye " + fixed(kept_mm, 3) +
                             " mm from the spindle axis; leave the job's \"eye\" out, or ask for "
                             "the rule \"cylinder\" with the radius " +
                             fixed(kept_mm, 3));
    }
}

struct NumericEyeInverse::Task {
    const EyeTarget& target;
    double turn_rad;
    std::span<const double> previous;
};

struct NumericEyeInverse::Found {
    std::vector<double> joints;
    double residual_mm = std::numeric_limits<double>::infinity();
    double twist_rad = std::numeric_limits<double>::infinity();

    [[nodiscard]] bool reached() const {
        return residual_mm <= kReached_mm && twist_rad <= kReached_rad;
    }
    // The place first: a fibre that is laid elsewhere is worse than a band that twists.
    [[nodiscard]] bool better_than(const Found& other) const {
        const bool here = residual_mm <= kReached_mm;
        const bool there = other.residual_mm <= kReached_mm;
        if (here && there) {
            return twist_rad < other.twist_rad;
        }
        return residual_mm < other.residual_mm;
    }
};

NumericEyeInverse::NumericEyeInverse(const Machine& machine)
    : machine_(machine), length_mm_(length_of(machine)) {
    if (const std::optional<double> sign = spindle_sign(machine)) {
        first_free_ = 1;
        spindle_sign_ = *sign;
    }
}

NumericEyeInverse::Found NumericEyeInverse::search(const Task& task, std::vector<double> start,
                                                   bool keep_limits, bool with_roller) const {
    const std::size_t free = machine_.axis_count() - first_free_;
    LeastSquaresProblem problem = problem_of_axes(machine_, first_free_, keep_limits);
    std::vector<double> joints = std::move(start);
    if (first_free_ == 1) {
        joints[0] = spindle_sign_ * task.turn_rad;
    }
    problem.evaluate = [&](const std::vector<double>& x, std::vector<double>& residuals,
                           std::vector<double>& jacobian) {
        std::copy(x.begin(), x.end(), joints.begin() + static_cast<std::ptrdiff_t>(first_free_));
        const Isometry3d mandrel = base_from_mandrel(machine_, joints);
        const Isometry3d eye = base_from_eye(machine_, joints);
        const Vector3d roller = eye.linear() * machine_.eye.roller;
        Vector3d wanted = mandrel.linear() * task.target.binormal;
        wanted *= roller.dot(wanted) < 0.0 ? -1.0 : 1.0;
        const Vector3d goal_mm = mandrel * task.target.eye_mm;
        const Vector3d place = (eye.translation() - goal_mm) / length_mm_;
        const double weight = with_roller ? 1.0 : 0.0;
        const auto motion =
            motions(machine_, joints, {goal_mm, wanted}, {eye.translation(), roller});
        for (std::size_t i = 0; i < 3; ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            residuals[i] = place[k];
            residuals[i + 3] = weight * (roller - wanted)[k];
            for (std::size_t j = 0; j < free; ++j) {
                jacobian[i * free + j] = motion[j + first_free_].point[k] / length_mm_;
                jacobian[(i + 3) * free + j] = weight * motion[j + first_free_].direction[k];
            }
        }
    };
    const double goal = std::min(kGoal_mm / length_mm_, kGoal_rad);
    const LeastSquaresResult result = damped_least_squares(
        problem, {joints.begin() + static_cast<std::ptrdiff_t>(first_free_), joints.end()}, goal,
        kMaxIterations);
    std::copy(result.x.begin(), result.x.end(),
              joints.begin() + static_cast<std::ptrdiff_t>(first_free_));
    turn_near(machine_, first_free_, task.previous, joints);
    Found found;
    const Isometry3d pose = mandrel_from_eye(machine_, joints);
    found.residual_mm = (pose.translation() - task.target.eye_mm).norm();
    found.twist_rad =
        angle_between_lines(pose.linear() * machine_.eye.roller, task.target.binormal);
    found.joints = std::move(joints);
    return found;
}

double NumericEyeInverse::singular_ratio(const std::vector<double>& joints) const {
    constexpr Eigen::Index kNeeded = 5;
    const auto free = static_cast<Eigen::Index>(machine_.axis_count() - first_free_);
    if (free < kNeeded) {
        return 0.0;
    }
    const Isometry3d eye = base_from_eye(machine_, joints);
    const Vector3d roller = eye.linear() * machine_.eye.roller;
    const Carried carried{eye.translation(), roller};
    const auto motion = motions(machine_, joints, carried, carried);
    Eigen::MatrixXd jacobian(static_cast<Eigen::Index>(kConstraints), free);
    for (Eigen::Index j = 0; j < free; ++j) {
        const Carried& m = motion[static_cast<std::size_t>(j) + first_free_];
        const bool linear =
            machine_.axis(static_cast<std::size_t>(j) + first_free_).type == AxisType::Linear;
        // An axis unit is a mm or as far as a rad takes the eye.
        jacobian.col(j) << (linear ? 1.0 : 1.0 / length_mm_) * m.point, m.direction;
    }
    const Eigen::VectorXd values = singular_values(jacobian);
    return values[0] > 0.0 ? values[kNeeded - 1] / values[0] : 0.0;
}

WristState NumericEyeInverse::solve(const EyeTarget& target, double turn_rad,
                                    std::span<const double> previous,
                                    std::span<double> joints) const {
    const std::vector<double> before(previous.begin(), previous.end());
    const Task task{target, turn_rad, before};
    DrawnStarts starts(machine_, {.first = first_free_, .endless_mm = kDrawn_mm});
    const std::size_t free = machine_.axis_count() - first_free_;
    constexpr std::size_t kNeeded = 5;
    Found best = search(task, before, true, true);
    for (int k = 1; k < kStarts && free >= kNeeded && !best.reached(); ++k) {
        Found other = search(task, starts.next(before), true, true);
        if (other.better_than(best)) {
            best = std::move(other);
        }
    }
    // Too few axes for both, or at the end of their travel: the place alone, then beyond the ends.
    for (const bool keep_limits : {true, false}) {
        if (best.residual_mm > kReached_mm) {
            Found other = search(task, best.joints, keep_limits, false);
            if (other.better_than(best)) {
                best = std::move(other);
            }
        }
    }
    WristState state;
    state.residual_mm = best.residual_mm;
    state.twist_rad = best.twist_rad;
    state.singular_sine = singular_ratio(best.joints);
    for (std::size_t j = machine_.mandrel_chain.size(); j < best.joints.size(); ++j) {
        if (machine_.axis(j).type == AxisType::Rotary) {
            state.flip_rad = std::max(state.flip_rad, std::abs(best.joints[j] - before[j]));
        }
    }
    state.flip = state.flip_rad > kFlip_rad;
    std::copy(best.joints.begin(), best.joints.end(), joints.begin());
    return state;
}

std::unique_ptr<EyeInverse> make_eye_inverse(const Machine& machine) {
    if (std::unique_ptr<ArmEyeInverse> arm = ArmEyeInverse::recognise(machine)) {
        return arm;
    }
    if (machine_class(machine).closed_form) {
        return std::make_unique<SpindleWristInverse>(machine);
    }
    return std::make_unique<NumericEyeInverse>(machine);
}

}  // namespace meshwind
