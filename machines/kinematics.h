/// Forward kinematics of any machine and the closed-form inverse of the spindle-and-wrist class.
///
/// Joint vectors: mandrel chain, then eye chain, each from the base outward; mm and rad. The
/// mandrel frame is carried along by the mandrel chain; at zero it is the machine frame, unless the
/// machine has a mount.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "machines/machine.h"

namespace meshwind {

/// Pose of the mandrel frame: product of exponentials of the mandrel chain, then the mount. \pre q
/// has machine.axis_count() entries
[[nodiscard]] Eigen::Isometry3d base_from_mandrel(const Machine& machine,
                                                  std::span<const double> q);

/// Product of exponentials of one chain up to and with axis `link`: it carries what is given "at
/// zero" to where it is. \pre `link` is a letter of either chain
[[nodiscard]] Eigen::Isometry3d base_from_link(const Machine& machine, std::span<const double> q,
                                               char link);

/// Pose of the eye: its origin is the eye point, its axes are those of the machine at zero, so that
/// `roller` and `exit` of the machine are directions in it.
[[nodiscard]] Eigen::Isometry3d base_from_eye(const Machine& machine, std::span<const double> q);

/// inverse(base_from_mandrel) * base_from_eye.
[[nodiscard]] Eigen::Isometry3d mandrel_from_eye(const Machine& machine, std::span<const double> q);

/// Jacobian of the eye's position against the mandrel: per axis, mm for a unit of the axis, in the
/// directions of the machine frame; 3 x axis_count(), first order.
[[nodiscard]] Eigen::Matrix3Xd eye_moves(const Machine& machine, std::span<const double> q);
/// An axis where the joints have brought it, base frame.
struct PlacedAxis {
    AxisType type = AxisType::Linear;
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
};

/// All axes of both chains in the order of the joint vector: the columns of the spatial Jacobian.
[[nodiscard]] std::vector<PlacedAxis> placed_axes(const Machine& machine,
                                                  std::span<const double> q);

/// Sign of the spindle's joint for a turn of the mandrel about +Z of the machine, +1 or -1, where
/// one rotary axis along +-Z through the origin is all that moves the mandrel; else nothing.
[[nodiscard]] std::optional<double> spindle_sign(const Machine& machine);

/// Whether the mandrel frame at zero is the machine frame, or that moved along Z.
[[nodiscard]] bool is_mounted_along_z(const Machine& machine);

/// Where the eye must be, mandrel frame.
struct EyeTarget {
    Eigen::Vector3d eye_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d tangent = Eigen::Vector3d::UnitY();  ///< unit, along the free fibre to the eye
    /// Unit, normal to the tangent: the roller is to be parallel to it, sign free.
    Eigen::Vector3d binormal = Eigen::Vector3d::UnitZ();
};

/// Quality of one inverse solution.
struct WristState {
    /// Sine of the angle between the machine's X axis and the vector that sets A (the roller axis
    /// with A and B, the fibre with A alone), 0..1. Small: a small move asks for much of A.
    double singular_sine = 1.0;
    bool held = false;       ///< singular_sine below kSingularSine: A is undefined and kept
    bool flip = false;       ///< A had to jump by about half a turn against the previous joints
    double flip_rad = 0.0;   ///< step of A, or of the wrist axis that had to turn most
    double twist_rad = 0.0;  ///< angle between roller and binormal, 0..pi/2; 0 with A and B
    /// Distance of the eye from where it is wanted; 0 with three linear axes.
    double residual_mm = 0.0;
};

/// Below this sine the direction of A is rounding noise of unit vectors, and keeping A turns the
/// roller by no more than this angle.
inline constexpr double kSingularSine = 1e-10;

/// Joints that bring the eye to a target; make_eye_inverse (machines/eye_inverse.h) chooses one.
class EyeInverse {
public:
    virtual ~EyeInverse() = default;

    /// Joints that bring the eye to `target` with the mandrel turned by `turn_rad` about +Z.
    /// \param turn_rad any real value; kept as it is, without wrapping
    /// \param previous joints to stay near to, axis_count() entries; all zero when there are none
    /// \param joints result, axis_count() entries, may be `previous` itself
    virtual WristState solve(const EyeTarget& target, double turn_rad,
                             std::span<const double> previous, std::span<double> joints) const = 0;

    /// The turn of the mandrel that the target forces where linear axes are missing: among the
    /// turns that bring the eye nearest to the target, one within the axes' travel, then the one
    /// nearest to `near_rad`. Nothing where the turn is free or the machine has none.
    [[nodiscard]] virtual std::optional<double> forced_turn(const EyeTarget& target,
                                                            double near_rad) const = 0;

    /// True for arms: a place has several solutions with no small step between them, and any axis
    /// may move the eye. Else rotary axes of the eye's chain turn the head alone.
    [[nodiscard]] virtual bool has_branches() const { return false; }

    /// With branches: every solution within the limits to begin a path at `target`.
    [[nodiscard]] virtual std::vector<std::vector<double>> starts(const EyeTarget& /*target*/,
                                                                  double /*turn_rad*/) const {
        return {};
    }
};

/// Closed-form inverse of the spindle-and-wrist class, recognised from the chains: one rotary axis
/// along +-Z through the origin in the mandrel chain (spindle); in the eye chain one to three
/// linear axes in any order, then perhaps a rotary axis along +-X (head roll, "A") and after it one
/// along +-Y (head swing, "B"), both through the eye; roller along +-Z and exit along -X at zero.
/// The mandrel may be mounted further along the spindle. Letters are free.
///
/// With roll a and swing b about +X and +Y the roller is u = (sin b, -sin a cos b, cos a cos b).
///  - roll only: u = (X x tau)/|X x tau| is at a right angle to the fibre: a = atan2(tau_z, tau_y),
///    tau turned into the machine frame, up to half turns because the sign of u is free;
///  - roll and swing: u = +-binormal, b = asin(u_x), a = atan2(-u_y, u_z), or (a + pi, pi - b);
///  - neither: the roller stays along Z and the band twists.
/// Among these and their whole turns the solution is the one nearest to the previous joints in the
/// largest rotary step, those within the axes' limits first.
/// With three linear axes the eye reaches any place at any turn. With fewer it comes as near as it
/// can at the given turn, and the distance is reported; forced_turn has the turn at which it is
/// least: without the axis along Y (Z and X left) the eye stays in a half-plane through the spindle
/// axis, and the turn is the central angle; with Z alone its distance from the spindle axis is
/// fixed too.
/// Accuracy: forward(inverse(pose)) = pose within 1e-9 mm and 1e-9 rad (kinematics_test.cpp).
class SpindleWristInverse final : public EyeInverse {
public:
    /// \throws InputError machine.missing_axis, machine.unsupported_chain
    explicit SpindleWristInverse(const Machine& machine);

    WristState solve(const EyeTarget& target, double turn_rad, std::span<const double> previous,
                     std::span<double> joints) const override;

    [[nodiscard]] std::optional<double> forced_turn(const EyeTarget& target,
                                                    double near_rad) const override;

    /// Turn of the mandrel about +Z in a joint vector.
    [[nodiscard]] double turn_rad(std::span<const double> joints) const {
        return spindle_sign_ * joints[0];
    }

    [[nodiscard]] std::size_t linear_axes() const { return linear_count_; }
    [[nodiscard]] bool has_roll() const { return has_roll_; }
    [[nodiscard]] bool has_swing() const { return has_swing_; }
    /// True when the eye reaches any height and any distance from the spindle axis with its exit
    /// towards the axis: three linear axes, or two that span the plane y = 0.
    [[nodiscard]] bool reaches_all() const;

private:
    struct RotaryJoint {
        std::size_t joint = 0;
        double sign = 1.0;  ///< +1: positive values turn right-handed about +X or +Y
        double min = 0.0;
        double max = 0.0;
    };
    struct Choice;

    void recognise_spindle(const Machine& machine);
    void recognise_mount(const Machine& machine);
    void recognise_linear(const Machine& machine);
    void recognise_wrist(const Machine& machine);
    void consider(double roll_rad, double swing_rad, Choice& best) const;
    void turn_head(const Eigen::Vector3d& tau, const Eigen::Vector3d& binormal, Choice& best,
                   WristState& state) const;
    [[nodiscard]] bool within_travel(const Eigen::Vector3d& linear) const;

    double spindle_sign_ = 1.0;
    std::size_t linear_count_ = 0;
    std::array<std::size_t, 3> linear_{};
    std::array<Axis, 3> linear_axis_;
    /// Columns: directions of the linear axes, zero where there is none; and their inverse, in the
    /// sense of least squares.
    Eigen::Matrix3d machine_from_linear_ = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d linear_from_machine_ = Eigen::Matrix3d::Zero();
    Eigen::Vector3d eye_zero_mm_ = Eigen::Vector3d::Zero();
    RotaryJoint roll_;
    RotaryJoint swing_;
    bool has_roll_ = false;
    bool has_swing_ = false;
};

}  // namespace meshwind
