/// Fillets crotches and steps of a wall, as a shop does with putty.
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
    std::string why_not;      ///< why a place to blend cannot be blended; in words
};

/// Per face 1 where a ball of the radius cannot touch its middle from outside (rolling_ball.h).
[[nodiscard]] std::vector<char> out_of_reach(const Surface& wall, double radius_mm);

/// Area of the wall, mm2, that a ball of the radius cannot touch from outside: the area that a
/// blend would fill up.
[[nodiscard]] double out_of_reach_mm2(const Surface& wall, double radius_mm);

/// Where a ball of the radius rolling over the wall cannot touch it, the wall is replaced by a
/// smooth continuation of both sides (fair.h): fillets in crotches and along concave creases, ramps
/// at steps. The wall is remeshed evenly; its regions merge where the crease between them is gone.
/// Elsewhere the wall stays on its surface.
/// \param kept per region: whether it is wall \param radius_mm > 0
/// \pre part is an oriented manifold, without slivers
[[nodiscard]] Blend blend_wall(const LabelledMesh& part, const std::vector<char>& kept,
                               double radius_mm);

}  // namespace meshwind
