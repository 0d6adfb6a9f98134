/// The report of a verification: verify.json, and the summary on the terminal.
#pragma once

#include <ostream>
#include <string>

#include "pipeline/resume/resume.h"
#include "pipeline/verify_text.h"

namespace meshwind {

/// Text of verify.json; keys as in docs/files.md. \param reading_s that the inputs took
[[nodiscard]] std::string verify_json(const VerifyOutcome& outcome, double reading_s);

/// What is left of a program that stopped, as JSON; keys as in docs/files.md.
/// \param file that it was written to, empty where a check failed
[[nodiscard]] std::string resume_json(const ResumedProgram& rest, const std::string& program,
                                      const std::string& file);

/// Where the program goes on, what is left of it, the checks.
void print_resume(std::ostream& out, const ResumedProgram& rest, const std::string& program);

/// What was wound, the checks, and where the program first goes wrong.
void print_verify(std::ostream& out, const VerifyOutcome& outcome);

}  // namespace meshwind
