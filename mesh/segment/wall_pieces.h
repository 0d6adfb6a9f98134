/// What of a wall hangs together.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/mandrel.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// Largest first. \param neighbours per face and edge, -1 where the wall ends
/// \param region id per face
[[nodiscard]] std::vector<WallPiece> wall_pieces(
    const TriangleSoup& soup, const std::vector<std::array<std::int32_t, 3>>& neighbours,
    const std::vector<std::int32_t>& region);

}  // namespace meshwind
