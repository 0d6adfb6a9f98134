#include "pipeline/code_digest.h"

#include "core/text/digest.h"
#include "postproc/verify/check_kinds.h"

namespace meshwind {

std::string code_digest(const Dialect& dialect, std::string_view text, const std::string& file) {
    return short_digest(dialect.code_of(text, file));
}

std::string job_digest(const Job& job) {
    return short_digest(job_text(job));
}

std::string write_with_digest(const Dialect& dialect, const Machine& machine, const BlockList& list,
                              const ProgramLayout& layout, ProgramHeader header) {
    header.code_digest.clear();
    header.code_digest =
        code_digest(dialect, dialect.write(machine, list, layout, header), machine.name);
    return dialect.write(machine, list, layout, header);
}

std::optional<Check> code_check(const Dialect& dialect, std::string_view text,
                                const std::string& file, const BlockList& program) {
    if (!program.head || program.head->code_digest.empty()) {
        return std::nullopt;
    }
    const std::string& written = program.head->code_digest;
    const std::string is = code_digest(dialect, text, file);
    Check check(check_kind::kCode, is == written);
    if (!check.ok) {
        check.words = "the blocks are not those that were written: their digest is " + is +
                      ", the program's head says " + written;
    }
    return check;
}

}  // namespace meshwind
