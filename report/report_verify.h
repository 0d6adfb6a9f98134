/// The report of a verification: verify.json, and the summary on the terminal.
#pragma once

#include <ostream>
#include <string>

#include "pipeline/resume/resume.h"
#include "pipeline/verify_text.h"

namespace meshwind {

/// Text of verify.json; keys as in docs/files.md. \param reading_s time spent on reading the inputs
[[nodiscard]] std::string verify_json(const VerifyOutcome& outcome, double reading_s);

/// The rest of a stopped program, as JSON; keys as in docs/files.md.
/// \param file its file, empty where a check failed
[[nodiscard]] std::string resume_json(const ResumedProgram& rest, const std::string& program,
                                      const std::string& file);

/// Prints the block where the program continues, its rest and the checks.
void print_resume(std::ostream& out, const ResumedProgram& rest, const std::string& program);

/// Prints the wound fibre, the checks, and the first wrong block of the program.
void print_verify(std::ostream& out, const VerifyOutcome& outcome);

}  // namespace meshwind
