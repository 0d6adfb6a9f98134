/// How a run ends: exit code, the line on stderr, and on stdout the error for programs.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "cli/streams.h"

namespace meshwind {

/// Runs, and makes of every way in which that can end an exit code and a line on stderr; where the
/// arguments have `--json` an error is an object on stdout, too (report/report_error.h).
[[nodiscard]] int run_to_the_end(const std::function<int()>& run,
                                 std::span<const std::string> arguments);

/// Writes out what was to be shown: it has to arrive, or whoever reads it takes a part for the
/// whole. \return `code`, or that of the failure
[[nodiscard]] int shown(HeldOutput& output, int code);

}  // namespace meshwind
