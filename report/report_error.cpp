#include "report/report_error.h"

#include <nlohmann/json.hpp>

#include "core/version.h"

namespace meshwind {

std::string error_json(const ErrorReport& error) {
    const nlohmann::json report = {
        {"meshwind", kVersion},
        {"ok", false},
        {"exit_code", error.exit_code},
        {"error", {{"code", error.code}, {"place", error.place}, {"message", error.words}}}};
    // Names of files need not be UTF-8.
    return report.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace meshwind
