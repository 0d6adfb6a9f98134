/// Inverse kinematics of machines on which an industrial robot moves the delivery eye.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "machines/kinematics.h"
#include "machines/machine.h"
#include "machines/pose_inverse.h"

namespace meshwind {

/// A robot that winds: an arm of ArmInverse's class with the eye at its flange, on the ground or on
/// a track of one linear axis, in front of a spindle. The head is held as a five-axis
/// winding machine holds it: its exit along -X, to the spindle axis, its roller at a right angle to
/// the fibre; the band twists on its way by `twist_rad`. A head that leaned to lay the band flat
/// would sweep the arm along the mandrel. That fixes one pose of the eye, for which PoseInverse has
/// the joints: the solution nearest to the previous joints, those within the axes' limits first. On
/// a track the arm stands abeam of the eye, or at the end of the track. `singular_sine` is the
/// smaller of the head's (the fibre along X) and the arm's (PoseState::singular).
/// Accuracy: forward(inverse(pose)) = pose within 1e-9 mm and 1e-9 rad (arm_eye_inverse_test.cpp).
class ArmEyeInverse final : public EyeInverse {
public:
    /// Nothing when the machine is of another class.
    [[nodiscard]] static std::unique_ptr<ArmEyeInverse> recognise(const Machine& machine);

    WristState solve(const EyeTarget& target, double turn_rad, std::span<const double> previous,
                     std::span<double> joints) const override;

    /// The turn is free.
    [[nodiscard]] std::optional<double> forced_turn(const EyeTarget& /*target*/,
                                                    double /*near_rad*/) const override {
        return std::nullopt;
    }

    [[nodiscard]] bool has_branches() const override { return true; }

    [[nodiscard]] std::vector<std::vector<double>> starts(const EyeTarget& target,
                                                          double turn_rad) const override;

    /// Whether the eye can be at a place, base frame, with the head held so.
    [[nodiscard]] bool reaches(const Eigen::Vector3d& eye_mm) const;

    [[nodiscard]] bool on_track() const { return track_.has_value(); }

private:
    struct Head;

    ArmEyeInverse(const Machine& machine, PoseInverse pose, double spindle_sign);

    [[nodiscard]] Head head_at(const EyeTarget& target, double turn_rad,
                               std::span<const double> previous) const;
    [[nodiscard]] Eigen::Isometry3d eye_pose(const EyeTarget& target, double turn_rad,
                                             const Head& head, double sign) const;
    [[nodiscard]] Eigen::Isometry3d place_base(Eigen::Isometry3d pose, double turn_rad,
                                               std::span<double> joints) const;

    Machine machine_;   ///< its chains and its eye alone
    PoseInverse pose_;  ///< of the six axes alone, with the eye as their mandrel
    double spindle_sign_ = 1.0;
    std::size_t first_ = 0;      ///< joint of the arm's first axis
    std::optional<Axis> track_;  ///< the axis before it
};

}  // namespace meshwind
