/// Parses RAPID into blocks.
#pragma once

#include <string>
#include <string_view>

#include "machines/machine.h"
#include "postproc/motion/block.h"

namespace meshwind {

/// Rapid::read.
[[nodiscard]] BlockList read_rapid(std::string_view text, const std::string& file,
                                   const Machine& machine);

/// Checks a header or footer line of the machine file: comments, and instructions that move
/// nothing, each whole. \throws InputError dialect.header_line
void check_own_rapid_line(const Machine& machine, const std::string& line);

}  // namespace meshwind
