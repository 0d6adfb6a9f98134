/// The report of a run: report.json.
#pragma once

#include <map>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/wind.h"

namespace meshwind {

/// report.json; keys as in docs/files.md.
/// \param timing_s seconds by stage: the run's, with those of writing it
[[nodiscard]] nlohmann::json report_of(const Run& run,
                                       const std::map<std::string, double>& timing_s);

/// Text of report.json, with the times of the run.
[[nodiscard]] std::string report_text(const Run& run);

}  // namespace meshwind
