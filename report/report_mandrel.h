/// The "mandrel" object of report.json.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "geodesic/path_accuracy.h"
#include "mesh/mandrel.h"
#include "mesh/revolution/revolution.h"
#include "mesh/segment/axis_candidates.h"
#include "mesh/tube/tube.h"

namespace meshwind {

/// file, unit_mm, unit_rule, triangles, file_to_mandrel (4x4, rows), axis, rims, area_mm2 (of the
/// winding surface), regions, repairs, smooth_fit, remarks. Rims and lengths in the mandrel frame,
/// mm.
[[nodiscard]] nlohmann::json mandrel_report(const Mandrel& mandrel);

/// The object "revolution": residual_mm, length_mm, ends, parts; only why_not where there is none.
[[nodiscard]] nlohmann::json revolution_report(const RevolutionFinding& finding);

/// The object "tube": residual_mm, length_mm, rims, lean_deg, radius, parts; only why_not where
/// there is none.
[[nodiscard]] nlohmann::json tube_report(const TubeFinding& finding);

/// The object "accuracy": paths, length_mm, walk_mm_per_m, patches_mm_per_m; null without paths.
[[nodiscard]] nlohmann::json accuracy_report(const PathAccuracy& accuracy);

/// The array "candidates" of "axis": rule, through, direction, residual_mm, swing_mm, rims,
/// gap_deg, angle_deg, off_mm, why.
[[nodiscard]] nlohmann::json axes_report(const std::vector<AxisCandidate>& axes);

/// The array "places": remark (its index in "remarks"), at.
[[nodiscard]] nlohmann::json places_report(const std::vector<RemarkPlace>& places);

}  // namespace meshwind
