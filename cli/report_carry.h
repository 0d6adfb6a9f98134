/// report.json and summary of `meshwind carry`.
#pragma once

#include <ostream>
#include <string>

#include "cli/carry_command.h"

namespace meshwind {

[[nodiscard]] std::string carry_json(const CarryOutcome& outcome);

void print_carry(std::ostream& out, const CarryOutcome& outcome);

}  // namespace meshwind
