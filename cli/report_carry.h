/// report.json and summary of `meshwind carry`.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "cli/carry_command.h"

namespace meshwind {

[[nodiscard]] std::string carry_json(const CarryOutcome& outcome);

/// Names of the files that a report of `carry` tells of, but for those that each run has; none
/// where it is the report of something else.
[[nodiscard]] std::vector<std::string> files_of_carry(const std::filesystem::path& report);

void print_carry(std::ostream& out, const CarryOutcome& outcome);

}  // namespace meshwind
