/// Finds the places of a wall that a rolling ball cannot touch.
#pragma once

#include <vector>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Which side of the wall the ball rolls on.
enum class WallSide { Outside, Inside };

/// Per face 1 where a ball of the radius cannot touch its middle: from outside in crotches, at the
/// foot of steps and in grooves; from inside in protrusions narrower than the ball.
/// \param wall oriented, mm \param radius_mm > 0
[[nodiscard]] std::vector<char> out_of_reach(const TriangleSoup& wall, double radius_mm,
                                             WallSide side);

}  // namespace meshwind
