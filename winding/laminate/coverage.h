/// How often the wall is covered, in numbers and per triangle.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "winding/laminate/samples.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// Fraction, mean, maximum and coefficient of variation of the layers; `reachable` is left at 0.
/// \param layers per coverage sample, n >= 1
[[nodiscard]] Coverage measure_coverage(std::span<const std::int32_t> layers);

/// Mean layers per face of the surface; for a face without a sample speak those of the nearest
/// faces with samples.
[[nodiscard]] std::vector<double> layers_per_face(const Surface& surface,
                                                  const CoverageSamples& samples,
                                                  std::span<const std::int32_t> layers);

}  // namespace meshwind
