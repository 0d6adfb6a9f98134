/// Checks that only plans with a pattern have.
#pragma once

#include <span>

#include "geodesic/surface_path.h"
#include "postproc/verify/verify.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// Whether wall is meant to stay bare, so that no share of it can be asked for: a lattice that is
/// not filled, or bands that are asked to be farther apart than they are wide.
[[nodiscard]] bool is_open(const Plan& plan);

/// Check "coverage" of such a plan: the share of the wall under bands, the ribs of both hands and
/// their crossings. It states them; there is no limit. \pre is_open(plan)
[[nodiscard]] Check open_coverage_check(const Plan& plan);

/// Check "closure" (postproc/verify/closure.h). \param laid what the program lays of the plan, all
/// of it \pre plan.pattern() has two circuits at least
[[nodiscard]] Check closure_check(const Plan& plan, std::span<const PathPoint> laid);

/// The same of the elbow planner's lines, on the straight stretches of the tube where they run
/// evenly; on all of it where these are shorter than two tow widths. \param meant what the program
/// would lay were its positions not rounded \pre plan.elbow() has two lines at least
[[nodiscard]] Check elbow_closure_check(const Plan& plan, double tow_width_mm,
                                        std::span<const PathPoint> laid,
                                        std::span<const PathPoint> meant);

}  // namespace meshwind
