/// Subprograms and repetitions of a LinuxCNC program.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "postproc/nc/program_flow.h"

namespace meshwind {

/// Finds the main program, which ends with the first M2, M30 or closing `%` outside an o-word
/// subprogram, and the subprograms of the file, in both forms that the interpreter has:
/// `O100` .. `M99` behind the end, called by `M98 P100 L5` in a line of its own, and `o100 sub` or
/// `o<name> sub` .. `o100 endsub` anywhere, called by `o100 call`; and `o100 repeat [5]` ..
/// `o100 endrepeat`. `O100` alone before the end is the program's own number and has no effect.
/// Text behind the end that belongs to no subprogram is skipped, as the interpreter does.
/// \param lines of the program without their ends
/// \throws InputError with file:line: nc.o_word for other o-words, arguments, expressions and other
/// words beside M98 or M99; nc.not_closed for blocks that are open at the end, closed without being
/// open, or not nested; nc.label_twice; the codes of a line that cannot be split.
/// Source: linuxcnc_g_code, o-code.adoc
[[nodiscard]] ProgramFlow linuxcnc_flow(std::span<const std::string_view> lines,
                                        const std::string& file);

/// The same for Fanuc controls: subprograms only as `O1001` .. `M99` behind M30, called by `M98
/// P1001 L20`; five levels with the main program; the file opens and closes with `%`. \throws
/// InputError as above; nc.no_end without the `%`
[[nodiscard]] ProgramFlow fanuc_flow(std::span<const std::string_view> lines,
                                     const std::string& file);

}  // namespace meshwind
