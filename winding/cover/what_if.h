/// What looser rules would bring.
#pragma once

#include <cstdint>
#include <vector>

#include "winding/cover/grow.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// What courses would reach if one rule were looser, for all rules that are worth a word, the most
/// useful first.
[[nodiscard]] std::vector<WhatIf> ask_what_if(const CourseRules& rules,
                                              const CoverageSamples& samples,
                                              const Library& library, std::uint64_t seed);

}  // namespace meshwind
