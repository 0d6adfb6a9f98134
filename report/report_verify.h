/// The report of a verification: verify.json, and the summary on the terminal.
#pragma once

#include <ostream>
#include <string>

#include "pipeline/verify_text.h"

namespace meshwind {

/// Text of verify.json; keys as in docs/files.md. \param reading_s that the inputs took
[[nodiscard]] std::string verify_json(const VerifyOutcome& outcome, double reading_s);

/// What was wound, the checks, and where the program first goes wrong.
void print_verify(std::ostream& out, const VerifyOutcome& outcome);

}  // namespace meshwind
