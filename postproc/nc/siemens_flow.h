/// Repeated sections of a Siemens program.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "postproc/nc/program_flow.h"

namespace meshwind {

/// A label stands alone in its line, `CIRCUIT_1:`; `REPEAT CIRCUIT_1 CIRCUIT_1_END P=19` runs the
/// lines between two labels 19 times more, wherever it stands; without P, once. Lines behind M30 or
/// M2 are not read. \param lines of the program without their ends
/// \throws InputError with file:line: nc.label_twice; nc.no_subprogram for a label that is not in
/// the file; nc.not_closed for sections that end before they begin, hold a REPEAT or are run from
/// within; nc.not_understood for other forms of REPEAT
[[nodiscard]] ProgramFlow siemens_flow(std::span<const std::string_view> lines,
                                       const std::string& file);

}  // namespace meshwind
