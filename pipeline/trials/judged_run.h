/// Judges runs of the main job, and compares two.
#pragma once

#include <cstdint>
#include <string>

#include "pipeline/plan_layer.h"
#include "pipeline/wind.h"

namespace meshwind {

/// Least gain in the covered share of the wall that is worth more fibres or a larger blend.
inline constexpr double kWorthMore = 0.005;

/// Least share of the reached wall that fibres must be able to join: a plan has to cover
/// kCoveredShare of it, and paths planned later to join the courses cover at most .02 more.
inline constexpr double kMinReach = kCoveredShare - 0.02;

[[nodiscard]] const Plan& first_plan(const Run& run);

/// Share of the wall that the run's first layer covers.
[[nodiscard]] double covered_share(const Run& run);

/// Share of the wall that fibres could join, up to the number that the job may take.
[[nodiscard]] double can_cover(const Run& run);

/// Whether its plan was too bare to be wound (WindOptions::least_covered).
[[nodiscard]] bool was_too_bare(const Run& run);

/// Whether it is a cover that was not wound and of which fibres could join enough.
[[nodiscard]] bool joins_enough(const Run& run);

/// Whether it was wound and passed every check.
[[nodiscard]] bool stands(const Run& run);

[[nodiscard]] bool turns_on_pins(const Job& job);

/// Whether a run is preferred to another: one that stands, then one that is planned, then one whose
/// gain in coverage is worth its further demands.
[[nodiscard]] bool is_better(const Run& run, const Run& than);

/// Whether a cover is wound, covers most of the possible share, and fails: courses that the machine
/// refuses in their places, which another choice of courses has elsewhere, leave wall bare or fail
/// themselves. A failure by bare wall alone is by chance where little is missing.
[[nodiscard]] bool fails_by_chance(const Run& run);

/// "with seed 3, 2 fibres, extensions of 150 mm and a blend of 6.0 mm 97.1 % of the wall is
/// covered, and 1 check fails: slip"
/// \param usual_seed seed that is not mentioned
[[nodiscard]] std::string tried_words(const Run& run, std::uint64_t usual_seed);

/// Settings that a job needs for the same run, in words.
[[nodiscard]] std::string settings_words(const Job& job);

}  // namespace meshwind
