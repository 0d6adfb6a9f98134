/// Axes of a machine as those of a robot and its external axes.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "machines/machine.h"

namespace meshwind {

inline constexpr std::size_t kArmAxes = 6;
inline constexpr std::size_t kMaxExternalAxes = 6;

/// Entries of the machine's joint vector by the robot's numbers.
struct RobotAxes {
    std::array<std::size_t, kArmAxes> arm{};  ///< axis 1 first
    /// First external axis first; nothing: the robot has none of this number.
    std::array<std::optional<std::size_t>, kMaxExternalAxes> external{};
};

/// The axes that the machine's controller names (Controller::robot_axes, external_axes). Without
/// names the last six axes of the eye's chain are axes 1 to 6 of the robot, and all others are
/// external, in the order of the joint vector: those of the mandrel's chain, then those that carry
/// the robot.
/// \pre names are of the machine's axes, each once (read_machine)
/// \throws InputError dialect.robot_axes unless the six are there and rotary and every other axis
/// has a number, or with more than six others
[[nodiscard]] RobotAxes robot_axes(const Machine& machine);

/// "axes 1 to 6: A B C U V W; external: X is E1, Z is E2".
/// \param names of the external axes in the language
[[nodiscard]] std::string robot_axes_words(const RobotAxes& axes, const Machine& machine,
                                           const std::array<const char*, kMaxExternalAxes>& names);

}  // namespace meshwind
