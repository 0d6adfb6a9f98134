/// The "mandrel" object of report.json.
#pragma once

#include <nlohmann/json.hpp>

#include "mesh/mandrel.h"

namespace meshwind {

/// file, unit_mm, unit_rule, triangles, file_to_mandrel (4x4, rows), axis, rims, area_mm2 (of what
/// is wound), regions, repairs, smooth_fit, remarks. Rims and lengths in the mandrel frame, mm.
[[nodiscard]] nlohmann::json mandrel_report(const Mandrel& mandrel);

}  // namespace meshwind
