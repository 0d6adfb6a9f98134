/// The report of a run: report.json, and the summary that a user reads on the terminal.
#pragma once

#include <ostream>
#include <string>

#include "cli/wind.h"

namespace meshwind {

/// Text of report.json; keys as in docs/files.md.
[[nodiscard]] std::string report_json(const WindResult& result);

/// A dozen lines: what was wound, how it is covered, the checks, where the files are.
void print_summary(std::ostream& out, const WindResult& result,
                   const std::filesystem::path& folder);

}  // namespace meshwind
