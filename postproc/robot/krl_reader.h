/// Parses KRL of the main job into blocks.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "machines/machine.h"
#include "postproc/motion/block.h"

namespace meshwind {

/// Lines before the first move, in this order and form, in small or capital letters.
inline constexpr std::array<std::string_view, 6> kKrlFirstLines = {
    "BAS(#INITMOV,0)", "$ADVANCE=3",       "$APO.CPTP=50",
    "$APO.CDIS=5",     "BAS(#VEL_PTP,10)", "BAS(#ACC_PTP,20)"};

/// Lines between the stop for the fibre and the first spline block.
inline constexpr std::array<std::string_view, 2> kKrlWindingLines = {"BAS(#VEL_PTP,100)",
                                                                     "BAS(#ACC_PTP,100)"};

/// Krl::read.
[[nodiscard]] BlockList read_robot_krl(std::string_view text, const std::string& file,
                                       const Machine& machine);

/// Checks a header or footer line of the machine file. \throws InputError dialect.header_line
void check_own_krl_line(const Machine& machine, const std::string& line);

}  // namespace meshwind
