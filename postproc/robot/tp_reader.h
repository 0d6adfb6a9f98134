/// Parses TP programs into blocks.
#pragma once

#include <string>
#include <string_view>

#include "machines/machine.h"
#include "postproc/motion/block.h"

namespace meshwind {

/// Tp::read.
[[nodiscard]] BlockList read_tp(std::string_view text, const std::string& file,
                                const Machine& machine);

/// Checks a header or footer line of the machine file. \throws InputError dialect.header_line
void check_own_tp_line(const Machine& machine, const std::string& line);

/// Small letters without blanks.
[[nodiscard]] std::string packed_tp(std::string_view text);

}  // namespace meshwind
