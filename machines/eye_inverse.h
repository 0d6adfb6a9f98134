/// Inverse kinematics for any machine, and the class of a machine.
#pragma once

#include <memory>
#include <string>

#include "machines/kinematics.h"
#include "machines/machine.h"

namespace meshwind {

/// Class of a machine, from its chains.
struct MachineClass {
    std::string words;         ///< "spindle, 3 linear axes, head roll and swing: closed form"
    bool spindle = false;      ///< the mandrel turns about the machine's Z axis alone
    bool closed_form = false;  ///< SpindleWristInverse holds
    bool arm = false;          ///< ArmEyeInverse holds
    bool free_turn = false;    ///< any turn of the mandrel lets the eye reach any place
    /// With a carriage along the spindle alone: the fixed distance of the eye from the spindle
    /// axis, which the main job keeps (EyeRule::Cylinder); else 0.
    double eye_distance_mm = 0.0;
    /// Why the main job cannot be run with it; empty: it can.
    std::string refusal;
};

[[nodiscard]] MachineClass machine_class(const Machine& machine);

/// \throws InputError machine.missing_axis, machine.unsupported_chain with the words of
/// MachineClass::refusal when the main job cannot be run with the machine, and where the machine
/// keeps the eye at another distance \param eye_distance_mm of a rule that keeps the eye at one
/// distance from the spindle axis; 0: of none
void require_main_job(const Machine& machine, double eye_distance_mm = 0.0);

/// Inverse of a machine outside the spindle class: damped least squares on the product of
/// exponentials. The eye is brought to its place with the roller along the binormal; a machine that
/// cannot do both brings the eye to its place and reports the remaining twist, and a place out of
/// reach gives the residual. A mandrel chain of one rotary axis along Z takes the turn that is
/// given; any other chain is free to move all its axes, and the turn is not used. Axes' limits are
/// kept where a solution within them is found.
/// `singular_sine` is the least singular value of the Jacobian over its largest one, or 0 when
/// there are fewer free axes than the five that a roller needs.
/// Accuracy: forward(inverse(pose)) = pose within 1e-9 mm and 1e-9 rad where residual_mm and
/// twist_rad say so (eye_inverse_test.cpp).
class NumericEyeInverse final : public EyeInverse {
public:
    explicit NumericEyeInverse(const Machine& machine);

    WristState solve(const EyeTarget& target, double turn_rad, std::span<const double> previous,
                     std::span<double> joints) const override;

    [[nodiscard]] std::optional<double> forced_turn(const EyeTarget& /*target*/,
                                                    double /*near_rad*/) const override {
        return std::nullopt;
    }

private:
    struct Found;
    struct Task;

    [[nodiscard]] Found search(const Task& task, std::vector<double> start, bool keep_limits,
                               bool with_roller) const;
    [[nodiscard]] double singular_ratio(const std::vector<double>& joints) const;

    Machine machine_;
    std::size_t first_free_ = 0;  ///< 1: the first axis is the spindle, its turn is given
    double spindle_sign_ = 1.0;
    double length_mm_ = 1.0;
};

/// SpindleWristInverse or ArmEyeInverse where one holds, else NumericEyeInverse.
[[nodiscard]] std::unique_ptr<EyeInverse> make_eye_inverse(const Machine& machine);

}  // namespace meshwind
