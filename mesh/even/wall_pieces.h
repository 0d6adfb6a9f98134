/// Connected pieces of a wall.
#pragma once

#include <vector>

#include "mesh/even/labelled_mesh.h"
#include "mesh/mandrel.h"

namespace meshwind {

/// Largest first, in the part's frame. \param kept per region: whether it is wall
[[nodiscard]] std::vector<WallPiece> wall_pieces(const LabelledView& part,
                                                 const std::vector<char>& kept);

}  // namespace meshwind
