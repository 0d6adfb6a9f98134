/// Coverage of the wall in figures, use of fibre, and mean layers per triangle.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "winding/laminate/samples.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// Fraction, mean, maximum, first percentile and coefficient of variation of the layers;
/// `reachable` is left at 0. \param layers per coverage sample, n >= 1 \param reached per sample:
/// whether the percentile counts it; empty: all do
[[nodiscard]] Coverage measure_coverage(std::span<const std::int32_t> layers,
                                        std::span<const char> reached = {});

/// \param wall_mm2 area to be covered \param layers asked for, > 0
[[nodiscard]] FibreUse fibre_use(const Plan& plan, double tow_width_mm, double wall_mm2,
                                 double layers);

/// Mean layers per face of the surface; a face without a sample takes those of the nearest faces
/// with samples.
[[nodiscard]] std::vector<double> layers_per_face(const Surface& surface,
                                                  const CoverageSamples& samples,
                                                  std::span<const std::int32_t> layers);

}  // namespace meshwind
