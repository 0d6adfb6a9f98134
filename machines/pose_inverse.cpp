#include "machines/pose_inverse.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/small_linear.h"
#include "core/units.h"
#include "machines/damped_least_squares.h"
#include "machines/drawn_starts.h"
#include "machines/kinematics.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Iterations end a hundred times nearer than what counts as reached.
constexpr double kGoalShare = 0.01;
constexpr int kMaxIterations = 200;
// Further starts when the previous joints lead nowhere.
constexpr int kStarts = 40;
// Largest step of one iteration, so that a search from the previous joints stays on its side.
constexpr double kStep_rad = 0.5;
constexpr double kStep_mm = 500.0;
// Where a linear axis has no end, further starts are drawn from this.
constexpr double kDrawn_mm = 2000.0;
// Rotations count at least like this far from their centre, so that a chain of linear axes alone
// has a length.
constexpr double kMinLength_mm = 100.0;
// What rounding near a singular pose may leave; what is off by more is out of reach.
constexpr double kRounding_mm = 1e-3;
constexpr double kRounding_rad = 1e-6;
// Joints that are nearer than this branch as the previous ones do.
constexpr double kSameWay_rad = 0.5;
// A step of more than this is a flip: as for wrists (kinematics.h).
constexpr double kFlip_rad = 0.5 * kPi;

// Rotation vector that turns `from` into `to`, accurate for small angles as well.
Vector3d rotation_between(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
    const Eigen::Matrix3d r = to * from.transpose();
    const Vector3d twice_sine(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
    const double sine = 0.5 * twice_sine.norm();
    const double cosine = 0.5 * (r.trace() - 1.0);
    if (cosine > 0.0 || sine > 1e-6) {
        return sine == 0.0 ? Vector3d(Vector3d::Zero())
                           : Vector3d(std::atan2(sine, cosine) / (2.0 * sine) * twice_sine);
    }
    const Eigen::AngleAxisd turn(r);  // about half a turn
    return turn.angle() * turn.axis();
}

double length_of(const Machine& machine) {
    const std::vector<double> zero(machine.axis_count(), 0.0);
    const Vector3d origin = base_from_mandrel(machine, zero).translation();
    double length = kMinLength_mm;
    for (const Axis& axis : machine.mandrel_chain) {
        if (axis.type == AxisType::Rotary) {
            length = std::max(length, (origin - axis.point_mm).cross(axis.direction).norm());
        }
    }
    return length;
}

// Motion of the mandrel's frame at its origin by each axis of its chain: three rows of mm per axis
// unit, three of rad.
std::vector<Eigen::Matrix<double, 6, 1>> columns(const Machine& machine,
                                                 std::span<const double> joints,
                                                 const Vector3d& origin) {
    const std::vector<PlacedAxis> placed = placed_axes(machine, joints);
    std::vector<Eigen::Matrix<double, 6, 1>> result(machine.mandrel_chain.size());
    for (std::size_t j = 0; j < result.size(); ++j) {
        const PlacedAxis& axis = placed[j];
        if (axis.type == AxisType::Linear) {
            result[j] << axis.direction, Vector3d::Zero();
        } else {
            result[j] << axis.direction.cross(origin - axis.point_mm), axis.direction;
        }
    }
    return result;
}

}  // namespace

struct PoseInverse::Choice {
    std::vector<double> joints;
    double residual_mm = std::numeric_limits<double>::infinity();
    double residual_rad = std::numeric_limits<double>::infinity();
    bool within_limits = false;
    double step_rad = std::numeric_limits<double>::infinity();

    [[nodiscard]] bool reached() const {
        return residual_mm <= kPoseReached_mm && residual_rad <= kPoseReached_rad;
    }
    [[nodiscard]] bool good() const { return reached() && within_limits; }
    // Reached comes first, then the limits, then the smaller step; of two that do not reach the
    // pose the nearer one.
    [[nodiscard]] bool better_than(const Choice& other, double length_mm) const {
        if (reached() != other.reached()) {
            return reached();
        }
        if (!reached()) {
            return residual_mm + length_mm * residual_rad <
                   other.residual_mm + length_mm * other.residual_rad;
        }
        return within_limits == other.within_limits ? step_rad < other.step_rad : within_limits;
    }
};

PoseInverse::PoseInverse(const Machine& machine)
    : machine_(machine), arm_(ArmInverse::recognise(machine)), length_mm_(length_of(machine)) {}

// Newton steps, near to the previous joints.
PoseInverse::Choice PoseInverse::refined(const Isometry3d& pose, std::span<const double> previous,
                                         std::vector<double> start, bool keep_limits) const {
    const std::size_t axes = machine_.mandrel_chain.size();
    LeastSquaresProblem problem;
    problem.residuals = 6;
    for (std::size_t j = 0; j < axes; ++j) {
        const Axis& axis = machine_.mandrel_chain[j];
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        problem.min.push_back(keep_limits ? axis.min : -kInfinity);
        problem.max.push_back(keep_limits ? axis.max : kInfinity);
        problem.max_step.push_back(axis.type == AxisType::Rotary ? kStep_rad : kStep_mm);
    }
    std::vector<double> joints(previous.begin(), previous.end());
    problem.evaluate = [&](const std::vector<double>& x, std::vector<double>& residuals,
                           std::vector<double>& jacobian) {
        std::copy(x.begin(), x.end(), joints.begin());
        const Isometry3d now = base_from_mandrel(machine_, joints);
        const Vector3d shift = (now.translation() - pose.translation()) / length_mm_;
        const Vector3d turn = rotation_between(pose.linear(), now.linear());
        const auto motion = columns(machine_, joints, now.translation());
        for (std::size_t i = 0; i < 3; ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            residuals[i] = shift[k];
            residuals[i + 3] = turn[k];
            for (std::size_t j = 0; j < axes; ++j) {
                jacobian[i * axes + j] = motion[j][k] / length_mm_;
                jacobian[(i + 3) * axes + j] = motion[j][k + 3];
            }
        }
    };
    const double goal = kGoalShare * std::min(kPoseReached_mm / length_mm_, kPoseReached_rad);
    const LeastSquaresResult found =
        damped_least_squares(problem, std::move(start), goal, kMaxIterations);
    std::copy(found.x.begin(), found.x.end(), joints.begin());

    Choice choice;
    choice.joints = std::move(joints);
    bring_near(previous, choice);
    measure_error(pose, choice);
    return choice;
}

// Whole turns bring each rotary joint near its previous value, within its travel if one does.
void PoseInverse::bring_near(std::span<const double> previous, Choice& choice) const {
    choice.step_rad = 0.0;
    choice.within_limits = true;
    for (std::size_t j = 0; j < machine_.mandrel_chain.size(); ++j) {
        const Axis& axis = machine_.mandrel_chain[j];
        double& joint = choice.joints[j];
        if (axis.type == AxisType::Rotary) {
            const double nearest =
                joint + 2.0 * kPi * std::round((previous[j] - joint) / (2.0 * kPi));
            joint = nearest;
            for (const double turns : {-1.0, 1.0}) {
                const bool inside = joint >= axis.min && joint <= axis.max;
                const double other = nearest + turns * 2.0 * kPi;
                if (!inside && other >= axis.min && other <= axis.max) {
                    joint = other;
                }
            }
            choice.step_rad = std::max(choice.step_rad, std::abs(joint - previous[j]));
        }
        choice.within_limits = choice.within_limits && joint >= axis.min && joint <= axis.max;
    }
}

void PoseInverse::measure_error(const Isometry3d& pose, Choice& choice) const {
    const Isometry3d now = base_from_mandrel(machine_, choice.joints);
    choice.residual_mm = (now.translation() - pose.translation()).norm();
    choice.residual_rad = rotation_between(pose.linear(), now.linear()).norm();
}

// A solution of the closed form near the previous joints; what rounding has left near a singular
// pose is mended.
PoseInverse::Choice PoseInverse::settled(const Isometry3d& pose, std::span<const double> previous,
                                         const ArmInverse::Joints& found) const {
    Choice choice;
    choice.joints.assign(previous.begin(), previous.end());
    std::copy(found.begin(), found.end(), choice.joints.begin());
    bring_near(previous, choice);
    measure_error(pose, choice);
    const bool rounding = choice.residual_mm < kRounding_mm && choice.residual_rad < kRounding_rad;
    return choice.reached() || !rounding
               ? choice
               : refined(pose, previous, {found.begin(), found.end()}, false);
}

PoseInverse::Choice PoseInverse::solve_arm(const Isometry3d& pose,
                                           std::span<const double> previous) const {
    const Choice near = settled(pose, previous, arm_->solve_near(pose, previous));
    if (near.good() && near.step_rad < kSameWay_rad) {
        return near;
    }
    Choice best;
    for (const ArmInverse::Joints& found : arm_->solve(pose, previous)) {
        Choice choice = settled(pose, previous, found);
        if (best.joints.empty() || choice.better_than(best, length_mm_)) {
            best = std::move(choice);
        }
    }
    return best;
}

PoseInverse::Choice PoseInverse::solve_numerically(const Isometry3d& pose,
                                                   std::span<const double> previous) const {
    const std::size_t axes = machine_.mandrel_chain.size();
    const std::vector<double> at_hand(previous.begin(),
                                      previous.begin() + static_cast<std::ptrdiff_t>(axes));
    DrawnStarts starts(machine_, {.endless_mm = kDrawn_mm});
    Choice best = refined(pose, previous, at_hand, true);
    for (int k = 1; k < kStarts && !best.good(); ++k) {
        Choice choice = refined(pose, previous, starts.next(at_hand), true);
        if (choice.better_than(best, length_mm_)) {
            best = std::move(choice);
        }
    }
    if (!best.good()) {
        Choice beyond = refined(
            pose, previous,
            {best.joints.begin(), best.joints.begin() + static_cast<std::ptrdiff_t>(axes)}, false);
        if (beyond.reached()) {
            best = std::move(beyond);
        }
    }
    return best;
}

void PoseInverse::measure(std::span<const double> joints, PoseState& state) const {
    if (arm_) {
        const ArmMeasure arm = arm_->measure(joints);
        state.singular = std::min({arm.shoulder, arm.elbow, arm.wrist});
        state.nearest = state.singular == arm.wrist   ? Singularity::Wrist
                        : state.singular == arm.elbow ? Singularity::Elbow
                                                      : Singularity::Shoulder;
        return;
    }
    const Vector3d origin = base_from_mandrel(machine_, joints).translation();
    const auto motion = columns(machine_, joints, origin);
    Eigen::MatrixXd jacobian(6, static_cast<Eigen::Index>(motion.size()));
    for (std::size_t j = 0; j < motion.size(); ++j) {
        auto column = jacobian.col(static_cast<Eigen::Index>(j));
        column = motion[j];
        column.tail<3>() *= length_mm_;
        column /= column.norm();
    }
    const Eigen::VectorXd values = singular_values(jacobian);
    state.singular = values[values.size() - 1] / values[0];
    state.nearest = Singularity::Other;
}

std::vector<std::vector<double>> PoseInverse::all(const Isometry3d& base_from_mandrel) const {
    assert(arm_);
    std::vector<double> middle(machine_.axis_count(), 0.0);
    for (std::size_t j = 0; j < machine_.mandrel_chain.size(); ++j) {
        const Axis& axis = machine_.mandrel_chain[j];
        middle[j] = std::isfinite(axis.min + axis.max) ? 0.5 * (axis.min + axis.max) : 0.0;
    }
    std::vector<std::vector<double>> ways;
    for (const ArmInverse::Joints& found : arm_->solve(base_from_mandrel, middle)) {
        Choice choice = settled(base_from_mandrel, middle, found);
        if (choice.good()) {
            ways.push_back(std::move(choice.joints));
        }
    }
    return ways;
}

bool PoseState::better_than(const PoseState& other) const {
    if (reached != other.reached) {
        return reached;
    }
    if (!reached) {
        return residual_mm < other.residual_mm;
    }
    return within_limits == other.within_limits ? largest_step_rad < other.largest_step_rad
                                                : within_limits;
}

PoseState PoseInverse::solve(const Isometry3d& base_from_mandrel, std::span<const double> previous,
                             std::span<double> joints) const {
    assert(previous.size() == machine_.axis_count() && joints.size() == previous.size());
    Choice best = arm_ ? solve_arm(base_from_mandrel, previous)
                       : solve_numerically(base_from_mandrel, previous);
    PoseState state;
    state.residual_mm = best.residual_mm;
    state.residual_rad = best.residual_rad;
    state.reached = best.reached();
    state.within_limits = best.within_limits;
    state.largest_step_rad = best.step_rad;
    state.flip = best.step_rad > kFlip_rad;
    measure(best.joints, state);
    std::copy(best.joints.begin(), best.joints.end(), joints.begin());
    return state;
}

}  // namespace meshwind
