/// Fits the smooth surface about corners, as heights through the vertices around them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/smooth/jet_fit.h"
#include "mesh/surface.h"

namespace meshwind {

/// Rings of neighbours that the fits of a frozen surface use: 18 vertices on a regular mesh.
inline constexpr int kFitRings = 2;

/// Jets at the corners `wanted`, from the vertices within `rings` rings on the corner's smooth side
/// (one ring more where they are few); curvature from facet normals where no fit is possible.
/// \param surface only positions, faces and corner indices are read
[[nodiscard]] std::vector<Jet> fit_corners(const Surface& surface,
                                           std::span<const std::int32_t> wanted, int rings);

}  // namespace meshwind
