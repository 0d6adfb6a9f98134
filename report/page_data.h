/// Data of report.html, in one binary text.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pipeline/wind.h"
#include "report/layup.h"

namespace meshwind {

/// Mandrel, fibre, motion, machine, programs and report of a run, for the page (viewer/src/data.ts
/// reads it), as page_arrays.h lays it out. The header has "report", "check_kinds"
/// (report_checks.h), "machine", "tow", "extension", and "layers" with their "fibres" and these
/// with their "pieces".
/// Positions are in the mandrel's frame, mm; angles deg. \param report report.json, whose
/// timing_s is left out
/// \pre run.planned()
[[nodiscard]] std::string page_data(const Run& run, const Layup& layup, nlohmann::json report);

}  // namespace meshwind
