/// Digests in a program's head: they detect changes of its code, and name its job.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "pipeline/job/job.h"
#include "postproc/motion/block.h"
#include "postproc/nc/dialect.h"
#include "postproc/verify/verify.h"

namespace meshwind {

/// Digest of Dialect::code_of of a text (core/text/digest.h): an accidental change of a program
/// changes it.
[[nodiscard]] std::string code_digest(const Dialect& dialect, std::string_view text,
                                      const std::string& file);

/// Digest of job_text().
[[nodiscard]] std::string job_digest(const Job& job);

/// The program with its own digest in the head.
[[nodiscard]] std::string write_with_digest(const Dialect& dialect, const Machine& machine,
                                            const BlockList& list, const ProgramLayout& layout,
                                            ProgramHeader header);

/// Check "code": the digest in the head is that of the code. None where the head has none.
[[nodiscard]] std::optional<Check> code_check(const Dialect& dialect, std::string_view text,
                                              const std::string& file, const BlockList& program);

}  // namespace meshwind
