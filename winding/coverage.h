/// How often the wall is covered, in numbers and per triangle.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "winding/plan.h"
#include "winding/samples.h"

namespace meshwind {

/// Fraction, mean, maximum and coefficient of variation of the layers; `reachable` is left at 0.
/// \param layers per coverage sample, n >= 1
[[nodiscard]] Coverage measure_coverage(std::span<const std::int32_t> layers);

/// Mean layers per face of the surface; a face without a sample takes the mean of its neighbours.
[[nodiscard]] std::vector<double> layers_per_face(const Surface& surface,
                                                  const CoverageSamples& samples,
                                                  std::span<const std::int32_t> layers);

/// Mean angle between fibre and spindle axis per face, 0..pi/2, weighted by the fibre's length in
/// the face; 0 where no course passes. On a branch across the spindle it is not the winding angle.
[[nodiscard]] std::vector<double> angle_per_face(const Surface& surface,
                                                 std::span<const Piece> pieces);

}  // namespace meshwind
