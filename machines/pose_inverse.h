/// Inverse kinematics of the mandrel chain: joints for a given pose of the mandrel.
#pragma once

#include <optional>
#include <span>
#include <string>

#include <Eigen/Geometry>

#include "machines/arm_inverse.h"
#include "machines/machine.h"

namespace meshwind {

/// A pose counts as reached within these; a product of six exponentials of some metres is good to a
/// thousandth of them.
inline constexpr double kPoseReached_mm = 1e-9;
inline constexpr double kPoseReached_rad = 1e-9;

/// Which singular pose an arm is nearest to.
enum class Singularity { Shoulder, Elbow, Wrist, Other };

/// Quality of one inverse solution.
struct PoseState {
    double residual_mm = 0.0;    ///< distance of the mandrel's origin from where it is wanted
    double residual_rad = 0.0;   ///< angle of its frame from what is wanted
    bool reached = false;        ///< both within kPoseReached_mm and kPoseReached_rad
    bool within_limits = false;  ///< all axes of the mandrel chain are within their travel
    /// 0 in a singular pose: the least of ArmMeasure where the closed form holds, else the least
    /// singular value of the Jacobian over its largest one (a rad counts as the arm's length).
    double singular = 1.0;
    Singularity nearest = Singularity::Other;
    bool flip = false;              ///< some rotary axis had to turn by more than a quarter turn
    double largest_step_rad = 0.0;  ///< of all rotary axes, against the previous joints

    /// Reached comes first, then the limits, then the smaller step.
    [[nodiscard]] bool better_than(const PoseState& other) const;
};

/// Inverse of a mandrel chain of any kind.
///  - arms (ArmInverse): all solutions in closed form, whole turns of every axis included; the
///    choice is the one within the limits, then the one with the smallest largest rotary step;
///  - any other chain: damped least squares from the previous joints, then from other starts until
///    the pose is reached within the limits; with more than six axes the solution is one of many.
/// A pose that cannot be reached gives the joints of the least error found, with the residuals;
/// joints beyond their travel are given only where none within reach the pose.
/// Accuracy: forward(inverse(pose)) = pose within 1e-9 mm and 1e-9 rad (pose_inverse_test.cpp).
class PoseInverse {
public:
    explicit PoseInverse(const Machine& machine);

    /// \param base_from_mandrel wanted pose of the mandrel frame in the machine frame
    /// \param previous joints to stay near to, axis_count() entries
    /// \param joints result, axis_count() entries; those of the eye chain are copied from
    ///        `previous`; may be `previous` itself
    PoseState solve(const Eigen::Isometry3d& base_from_mandrel, std::span<const double> previous,
                    std::span<double> joints) const;

    /// All solutions for a pose within the limits, rotary joints as near to the middle of their
    /// travel as whole turns bring them. \pre closed_form()
    [[nodiscard]] std::vector<std::vector<double>> all(
        const Eigen::Isometry3d& base_from_mandrel) const;

    /// True where the closed form holds.
    [[nodiscard]] bool closed_form() const { return arm_.has_value(); }

    /// Sets PoseState::singular and PoseState::nearest for any joints.
    void measure(std::span<const double> joints, PoseState& state) const;

private:
    struct Choice;

    [[nodiscard]] Choice solve_arm(const Eigen::Isometry3d& pose,
                                   std::span<const double> previous) const;
    void bring_near(std::span<const double> previous, Choice& choice) const;
    void measure_error(const Eigen::Isometry3d& pose, Choice& choice) const;
    [[nodiscard]] Choice settled(const Eigen::Isometry3d& pose, std::span<const double> previous,
                                 const ArmInverse::Joints& found) const;
    [[nodiscard]] Choice solve_numerically(const Eigen::Isometry3d& pose,
                                           std::span<const double> previous) const;
    [[nodiscard]] Choice refined(const Eigen::Isometry3d& pose, std::span<const double> previous,
                                 std::vector<double> start, bool keep_limits) const;

    Machine machine_;
    std::optional<ArmInverse> arm_;
    double length_mm_ = 1.0;  ///< of the chain: what a rad counts in mm
};

}  // namespace meshwind
