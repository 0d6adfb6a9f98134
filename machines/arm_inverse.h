/// Closed-form inverse kinematics of a six-axis arm: the mandrel on a robot's flange.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "machines/machine.h"

namespace meshwind {

/// How far an arm is from its three singular poses; each 0 (there) to 1.
struct ArmMeasure {
    double shoulder = 1.0;  ///< distance of the wrist centre from axis 1 over the arm's length
    double elbow = 1.0;     ///< sine of the angle between upper arm and forearm
    double wrist = 1.0;     ///< sine of the angle between axes 4 and 6
};

/// Mandrel chains of six rotary axes of which 2 and 3 are parallel, 1 is not parallel to them, and
/// 4, 5 and 6 meet in one point, neighbours not parallel: the common industrial robot, whatever its
/// offsets. Source: murray_1994_robotic_manipulation, sec. 3.3 (subproblems of Paden and Kahan);
/// axis 1 from the component of the wrist centre along axis 2, which axes 2 and 3 keep.
class ArmInverse {
public:
    /// Nothing when the chain is of another class.
    [[nodiscard]] static std::optional<ArmInverse> recognise(const Machine& machine);

    using Joints = std::array<double, 6>;

    /// All solutions, 8 at most (shoulder, elbow and wrist either way), joints in (-2 pi, 2 pi).
    /// For a pose out of reach, joints that come near it. Exactly in a singular pose the free joint
    /// keeps its previous value.
    [[nodiscard]] std::vector<Joints> solve(const Eigen::Isometry3d& base_from_mandrel,
                                            std::span<const double> previous) const;

    /// The solution on the branch of the previous joints: at axes 1, 3 and then the wrist the
    /// angles nearest to theirs. An eighth of the work.
    [[nodiscard]] Joints solve_near(const Eigen::Isometry3d& base_from_mandrel,
                                    std::span<const double> previous) const;

    /// Distance of any joints from the singular poses. \pre at least six
    [[nodiscard]] ArmMeasure measure(std::span<const double> joints) const;

private:
    struct Screw {
        Eigen::Vector3d direction;
        Eigen::Vector3d point_mm;
        [[nodiscard]] Eigen::Isometry3d motion(double angle_rad) const;
        [[nodiscard]] Eigen::Vector3d across(const Eigen::Vector3d& point_mm) const;
    };

    [[nodiscard]] std::array<double, 2> shoulder_angles(const Eigen::Vector3d& wrist_mm,
                                                        double previous) const;
    [[nodiscard]] std::array<double, 2> elbow_angles(double distance_mm) const;
    [[nodiscard]] double upper_arm_angle(double elbow_rad, const Eigen::Vector3d& reached) const;
    [[nodiscard]] std::array<Joints, 2> wrist_angles(const Eigen::Isometry3d& motion, Joints joints,
                                                     std::span<const double> previous) const;

    std::array<Screw, 6> axis_;
    Eigen::Vector3d wrist_mm_ = Eigen::Vector3d::Zero();  ///< where axes 4, 5 and 6 meet
    Eigen::Isometry3d mandrel_at_zero_ = Eigen::Isometry3d::Identity();
};

}  // namespace meshwind
