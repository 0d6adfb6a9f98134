/// Axes of a machine as those of a robot and its external axes, and the limits that languages of
/// robots have in common.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "machines/machine.h"
#include "postproc/motion/block.h"

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

/// Largest distance of an axis' positions from what a controller holds that keeps each in a 32-bit
/// float, mm or deg. Positions are absolute, so that nothing adds up.
[[nodiscard]] double float32_rounding(const BlockList& list, std::size_t axis);

/// The coarsest positions that a program may get by that, mm or deg: as coarse as the steps of
/// controllers that add in floats (kCoarsestBinary), reached at 1 048 576.
inline constexpr double kMaxRounding = 1.0 / 32.0;

/// \throws InputError dialect.float32 when an axis goes beyond that \param controller in messages
void check_float32(const BlockList& list, const std::string& controller);

/// A remark for each axis whose positions the controller rounds by more than half a step.
[[nodiscard]] std::vector<std::string> float32_notes(const BlockList& list);

/// \throws InputError dialect.duration for a block without time or motion: no language of robots
/// has a word for it
void check_moves(const BlockList& list);

}  // namespace meshwind
