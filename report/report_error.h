/// An error as JSON, for programs that asked for a report.
#pragma once

#include <string>

namespace meshwind {

struct ErrorReport {
    std::string code;   ///< docs/errors.md
    std::string place;  ///< file, file:line or file: /json/pointer; may be empty
    std::string words;  ///< the line on stderr, without the program's name
    int exit_code = 2;
};

/// {"meshwind": version, "ok": false, "exit_code": .., "error": {"code", "place", "message"}}
[[nodiscard]] std::string error_json(const ErrorReport& error);

}  // namespace meshwind
