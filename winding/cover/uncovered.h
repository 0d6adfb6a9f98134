/// Why wall is bare, and what looser rules would bring.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "winding/cover/grow_library.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// Groups the samples without a layer by region and reason: what became of most courses that pass
/// there, with how many courses that is, or where none passes the last check that a candidate
/// failed. \param rejection per member; None where it could have been laid
/// \param layers per sample
[[nodiscard]] std::vector<Uncovered> uncovered_wall(const Surface& surface,
                                                    const CoverageSamples& samples,
                                                    const Library& library,
                                                    std::span<const CourseFault> rejection,
                                                    std::span<const std::int32_t> layers);

/// What courses would reach if one rule were looser, for all rules that are worth a word, the most
/// useful first.
[[nodiscard]] std::vector<RelaxedRule> coverage_if_relaxed(const CourseRules& rules,
                                                           const CoverageSamples& samples,
                                                           const Library& library,
                                                           std::uint64_t seed);

}  // namespace meshwind
