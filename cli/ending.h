/// Ends a run: exit code, the line on stderr, and on stdout the error for programs.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "cli/streams.h"

namespace meshwind {

/// Runs, and turns every ending into an exit code and a line on stderr; where the arguments have
/// `--json` an error is an object on stdout, too (report/report_error.h).
[[nodiscard]] int run_to_the_end(const std::function<int()>& run,
                                 std::span<const std::string> arguments);

/// Writes the held output; a failure is an error, since readers would take a part for the whole.
/// \return `code`, or that of the failure
[[nodiscard]] int shown(HeldOutput& output, int code);

}  // namespace meshwind
