/// What a run of the main job came to, and which of two is better.
#pragma once

#include <cstdint>
#include <string>

#include "pipeline/plan_layer.h"
#include "pipeline/wind.h"

namespace meshwind {

/// More fibres or a larger blend cover so much more of the wall, or they are not worth it.
inline constexpr double kWorthMore = 0.005;

/// Share of what courses reach that fibres have to be able to join: a plan has to cover
/// kCoveredShare of it, and what is planned later to join the courses covers .02 on top at most.
inline constexpr double kMinReach = kCoveredShare - 0.02;

[[nodiscard]] const Plan& first_plan(const Run& run);

/// Share of the wall that the run's first layer covers.
[[nodiscard]] double covered_share(const Run& run);

/// Share of the wall that fibres could join, as many as the job may take.
[[nodiscard]] double can_cover(const Run& run);

/// Whether its plan was too bare to be wound (WindOptions::least_covered).
[[nodiscard]] bool was_too_bare(const Run& run);

/// Whether it is a cover that was not wound, and that fibres could join enough of.
[[nodiscard]] bool joins_enough(const Run& run);

/// Whether it was wound and passed every check.
[[nodiscard]] bool stands(const Run& run);

[[nodiscard]] bool turns_on_pins(const Job& job);

/// Whether a run is to be taken instead of another: one that stands, then one that is planned, then
/// what covers more by as much as what it asks for besides is worth.
[[nodiscard]] bool is_better(const Run& run, const Run& than);

/// A cover that is wound, covers most of what it can, and fails: courses that the machine refuses
/// in their places, which another choice of courses has elsewhere, leave wall bare or fail
/// themselves. What fails for bare wall alone does so by chance where little lacks.
[[nodiscard]] bool fails_by_chance(const Run& run);

/// "with seed 3, 2 fibres, extensions of 150 mm and a blend of 6.0 mm 97.1 % of the wall is
/// covered, and 1 check fails: slip"
/// \param usual_seed with which no seed is told
[[nodiscard]] std::string tried_words(const Run& run, std::uint64_t usual_seed);

/// What the job has to say for the same run.
[[nodiscard]] std::string settings_words(const Job& job);

}  // namespace meshwind
