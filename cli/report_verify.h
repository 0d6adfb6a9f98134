/// The report of a verification: verify.json, and the summary on the terminal.
#pragma once

#include <ostream>
#include <string>

#include "cli/verify_command.h"

namespace meshwind {

/// Text of verify.json; keys as in docs/files.md.
[[nodiscard]] std::string verify_json(const VerifyOutcome& outcome);

/// What was wound, the checks, and where the program first goes wrong.
void print_verify(std::ostream& out, const VerifyOutcome& outcome);

}  // namespace meshwind
