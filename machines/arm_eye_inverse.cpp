#include "machines/arm_eye_inverse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::size_t kArmAxes = 6;

// What kinematics needs: envelopes may be meshes.
Machine chains_of(const Machine& machine) {
    Machine chains;
    chains.mandrel_chain = machine.mandrel_chain;
    chains.eye_chain = machine.eye_chain;
    chains.mount = machine.mount;
    chains.eye.position_mm = machine.eye.position_mm;
    chains.eye.roller = machine.eye.roller;
    chains.eye.exit = machine.eye.exit;
    return chains;
}

// The last six axes of the eye's chain, with the eye as the mandrel that they carry.
Machine arm_of(const Machine& machine) {
    Machine arm;
    arm.mandrel_chain.assign(machine.eye_chain.end() - kArmAxes, machine.eye_chain.end());
    arm.mount = MandrelMount{.origin_mm = machine.eye.position_mm};
    return arm;
}

}  // namespace

// How the head is held, its exit along -X: in the frame of the machine.
struct ArmEyeInverse::Head {
    Vector3d roller;
    double sine = 1.0;  // of the angle between fibre and X
    double twist_rad = 0.0;
};

std::unique_ptr<ArmEyeInverse> ArmEyeInverse::recognise(const Machine& machine) {
    const std::vector<Axis>& chain = machine.eye_chain;
    const bool tracked = !chain.empty() && chain.front().type == AxisType::Linear;
    const std::optional<double> sign = spindle_sign(machine);
    if (chain.size() != (tracked ? 1U : 0U) + kArmAxes || !sign || !is_mounted_along_z(machine)) {
        return nullptr;
    }
    PoseInverse pose(arm_of(machine));
    if (!pose.closed_form()) {
        return nullptr;
    }
    return std::unique_ptr<ArmEyeInverse>(new ArmEyeInverse(machine, std::move(pose), *sign));
}

ArmEyeInverse::ArmEyeInverse(const Machine& machine, PoseInverse pose, double spindle_sign)
    : machine_(chains_of(machine)),
      pose_(std::move(pose)),
      spindle_sign_(spindle_sign),
      first_(machine.axis_count() - kArmAxes) {
    if (machine.eye_chain.size() > kArmAxes) {
        track_ = machine.eye_chain.front();
    }
}

ArmEyeInverse::Head ArmEyeInverse::head_at(const EyeTarget& target, double turn_rad,
                                           std::span<const double> previous) const {
    const Eigen::AngleAxisd turn(turn_rad, Vector3d::UnitZ());
    const Vector3d across = Vector3d::UnitX().cross(turn * target.tangent);
    Head head;
    head.sine = across.norm();
    if (head.sine < kSingularSine) {  // any roller would do: the one that was
        const Vector3d was = base_from_eye(machine_, previous).linear() * machine_.eye.roller;
        head.roller = Vector3d(0.0, was.y(), was.z()).normalized();
    } else {
        head.roller = across / head.sine;
    }
    const Vector3d band = turn * target.binormal;
    head.twist_rad = std::atan2(head.roller.cross(band).norm(), std::abs(head.roller.dot(band)));
    return head;
}

// Where the eye is to be, base frame.
Isometry3d ArmEyeInverse::eye_pose(const EyeTarget& target, double turn_rad, const Head& head,
                                   double sign) const {
    const auto frame = [](const Vector3d& roller, const Vector3d& exit) {
        Eigen::Matrix3d axes;
        axes << roller, exit, roller.cross(exit);
        return axes;
    };
    Isometry3d eye = Isometry3d::Identity();
    eye.linear() = frame(sign * head.roller, -Vector3d::UnitX()) *
                   frame(machine_.eye.roller, machine_.eye.exit).transpose();
    eye.translation() = Eigen::AngleAxisd(turn_rad, Vector3d::UnitZ()) * target.eye_mm;
    if (machine_.mount) {
        eye.translation() += machine_.mount->origin_mm;
    }
    return eye;
}

// Sets what is given, spindle and track; the pose of the eye as seen from the foot of the arm.
Isometry3d ArmEyeInverse::place_base(Isometry3d pose, double turn_rad,
                                     std::span<double> joints) const {
    joints[0] = spindle_sign_ * turn_rad;
    if (track_) {
        const Vector3d& foot = machine_.axis(first_).point_mm;
        double& place = joints[first_ - 1];
        place =
            std::clamp(track_->direction.dot(pose.translation() - foot), track_->min, track_->max);
        pose.pretranslate(Vector3d(-place * track_->direction));
    }
    return pose;
}

std::vector<std::vector<double>> ArmEyeInverse::starts(const EyeTarget& target,
                                                       double turn_rad) const {
    std::vector<double> joints(machine_.axis_count(), 0.0);
    const Head head = head_at(target, turn_rad, joints);
    std::vector<std::vector<double>> ways;
    for (const double sign : {1.0, -1.0}) {
        const Isometry3d pose =
            place_base(eye_pose(target, turn_rad, head, sign), turn_rad, joints);
        for (const std::vector<double>& way : pose_.all(pose)) {
            std::copy(way.begin(), way.end(), joints.begin() + static_cast<std::ptrdiff_t>(first_));
            ways.push_back(joints);
        }
    }
    return ways;
}

bool ArmEyeInverse::reaches(const Vector3d& eye_mm) const {
    EyeTarget target{.eye_mm = eye_mm};
    if (machine_.mount) {
        target.eye_mm -= machine_.mount->origin_mm;
    }
    // With the roller one way and square to that: axis 6 may have ends.
    for (const Vector3d& tangent : {Vector3d(0.0, 1.0, 0.0), Vector3d(0.0, 0.0, 1.0)}) {
        target.tangent = tangent;
        if (!starts(target, 0.0).empty()) {
            return true;
        }
    }
    return false;
}

WristState ArmEyeInverse::solve(const EyeTarget& target, double turn_rad,
                                std::span<const double> previous, std::span<double> joints) const {
    std::array<double, kArmAxes> before{};
    std::copy_n(previous.begin() + static_cast<std::ptrdiff_t>(first_), kArmAxes, before.begin());
    const Head head = head_at(target, turn_rad, previous);
    const Vector3d before_roller = base_from_eye(machine_, previous).linear() * machine_.eye.roller;
    const double first_sign = std::copysign(1.0, before_roller.dot(head.roller));
    PoseState best;
    for (const double sign : {first_sign, -first_sign}) {
        const Isometry3d pose =
            place_base(eye_pose(target, turn_rad, head, sign), turn_rad, joints);
        std::array<double, kArmAxes> found{};
        const PoseState state = pose_.solve(pose, before, found);
        if (sign == first_sign || state.better_than(best)) {
            best = state;
            std::copy(found.begin(), found.end(),
                      joints.begin() + static_cast<std::ptrdiff_t>(first_));
        }
        if (best.reached && best.within_limits && !best.flip) {
            break;
        }
    }
    return {.singular_sine = std::min(best.singular, head.sine),
            .held = head.sine < kSingularSine,
            .flip = best.flip,
            .flip_rad = best.largest_step_rad,
            .twist_rad = head.twist_rad + best.residual_rad,
            .residual_mm = best.residual_mm};
}

}  // namespace meshwind
