/// Head, approach and own lines of programs in languages of robots.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "machines/machine.h"
#include "postproc/motion/block.h"
#include "postproc/nc/dialect.h"
#include "postproc/nc/nc_flavour.h"
#include "postproc/robot/robot_axes.h"

namespace meshwind {

/// What is written.
struct RobotSource {
    const Machine& machine;
    const BlockList& list;
    const ProgramHeader& header;
    NcFlavour flavour{};  ///< of comments
    RobotAxes axes{};
};

/// The head's comments: those of every program, which axes are the robot's, what 32-bit floats take
/// off. \param external names of the external axes in the language
[[nodiscard]] std::string robot_head(const RobotSource& source,
                                     const std::array<const char*, kMaxExternalAxes>& external);

/// Comments before the move to the start.
[[nodiscard]] std::string robot_approach(const RobotSource& source);

/// What the operator is to do at the stop.
[[nodiscard]] std::string robot_tie_on(const RobotSource& source);

/// The controller's own lines with their places filled in. \param check throws InputError
/// dialect.header_line for a line that cannot be used \throws InputError dialect.placeholder
[[nodiscard]] std::string robot_own_lines(
    const RobotSource& source, const std::vector<std::string>& lines,
    const std::function<void(const Machine&, const std::string&)>& check);

/// Calls `read` for a line of the machine's own, and says why it cannot be used when that throws
/// or the line is not plain ASCII. \throws InputError dialect.header_line
void check_robot_line(const Machine& machine, const std::string& line,
                      const std::function<void()>& read);

/// "course 3" as a comment where a block begins another piece than the last one. \param piece of
/// the last comment
void append_course(const RobotSource& source, std::size_t block, std::int32_t& piece,
                   std::string& text);

/// Position of an axis with the digits of its step.
void append_robot_axis(const BlockList& list, std::size_t block, std::size_t axis,
                       std::string& text);

}  // namespace meshwind
