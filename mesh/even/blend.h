/// Crotches and steps filled up, as a shop does it with putty.
#pragma once

#include <string>
#include <vector>

#include "mesh/even/labelled_mesh.h"
#include "mesh/surface.h"

namespace meshwind {

struct Blend {
    LabelledMesh part;        ///< the given one where there is nothing to blend
    double area_mm2 = 0.0;    ///< of the wall that is blended
    double volume_mm3 = 0.0;  ///< filled in
    std::string why_not;      ///< where something would be blended and cannot be; in words
};

/// Per face 1 where a ball of the radius cannot touch its middle from outside (rolling_ball.h).
[[nodiscard]] std::vector<char> out_of_reach(const Surface& wall, double radius_mm);

/// Area of the wall, mm2, that a ball of the radius cannot touch from outside: what a blend would
/// fill up.
[[nodiscard]] double out_of_reach_mm2(const Surface& wall, double radius_mm);

/// Where a ball of the radius that rolls over the wall cannot touch it, the wall becomes the smooth
/// surface that goes on from both sides (fair.h): fillets in crotches and along concave creases,
/// ramps at steps. The wall is laid out in even triangles; its regions are one where a crease
/// between them is gone. Walls of any other place stay on their surface.
/// \param kept per region: whether it is wall \param radius_mm > 0
/// \pre part is an oriented manifold, without slivers
[[nodiscard]] Blend blend_wall(const LabelledMesh& part, const std::vector<char>& kept,
                               double radius_mm);

}  // namespace meshwind
