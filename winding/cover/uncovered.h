/// Reasons for bare wall, and the coverage in reach if one rule were relaxed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "winding/cover/grow_library.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// Groups the samples without a layer by region and reason: the commonest fault of the courses that
/// pass there, with their number, or where none passes the last check that a candidate failed.
/// \param rejection per member; None where it could have been laid
/// \param layers per sample
[[nodiscard]] std::vector<Uncovered> uncovered_wall(const Surface& surface,
                                                    const CoverageSamples& samples,
                                                    const Library& library,
                                                    std::span<const CourseFault> rejection,
                                                    std::span<const std::int32_t> layers);

/// Coverage in reach if one rule were relaxed, for all rules worth reporting, the most useful
/// first.
[[nodiscard]] std::vector<RelaxedRule> coverage_if_relaxed(const CourseRules& rules,
                                                           const CoverageSamples& samples,
                                                           const Library& library,
                                                           std::uint64_t seed);

}  // namespace meshwind
