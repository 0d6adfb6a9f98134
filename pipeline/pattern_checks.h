/// Checks of plans with a pattern: open coverage and closure.
#pragma once

#include <span>

#include "geodesic/surface_path.h"
#include "postproc/verify/verify.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// Whether wall is meant to stay bare, so that no covered share can be required: an unfilled
/// lattice, or bands farther apart than they are wide.
[[nodiscard]] bool is_open(const Plan& plan);

/// Check "coverage" of such a plan: the share of the wall under bands, the ribs of both hands and
/// their crossings. It only states them; there is no limit. \pre is_open(plan)
[[nodiscard]] Check open_coverage_check(const Plan& plan);

/// Check "closure" (postproc/verify/closure.h). \param laid all fibre that the program lays of the
/// plan \pre plan.pattern() has two circuits at least
[[nodiscard]] Check closure_check(const Plan& plan, std::span<const PathPoint> laid);

/// The same for the elbow planner's lines, on the straight stretches of the tube where they run
/// evenly; on all of it where these are shorter than two tow widths. \param meant fibre that the
/// program would lay with unrounded positions \pre plan.elbow() has two lines at least
[[nodiscard]] Check elbow_closure_check(const Plan& plan, double tow_width_mm,
                                        std::span<const PathPoint> laid,
                                        std::span<const PathPoint> meant);

}  // namespace meshwind
