/// Removes lettering, logos and specks from a wall.
#pragma once

#include <vector>

#include "mesh/even/labelled_mesh.h"

namespace meshwind {

struct Details {
    LabelledMesh part;      ///< the given one where nothing was removed
    TriangleSoup removed;   ///< the details, in the given triangles
    int count = 0;          ///< connected letters count once
    double area_mm2 = 0.0;  ///< of the given triangles
    double most_mm = 0.0;   ///< largest height or depth of one from the wall
};

/// Removes details with all that they enclose, and continues the wall smoothly over their places. A
/// detail stands out of the wall, or goes into it, by at most `height_mm`, is surrounded by wall,
/// and is too narrow for a ball of `ball_mm` rolling on the other side to fill. A feature is no
/// detail if it goes around a leg, reaches an end, takes a twentieth of the wall, or is too low to
/// tell from the wall's own unevenness (`least_mm`).
/// \param kept per region: whether it is wall \pre part is an oriented manifold, without slivers
[[nodiscard]] Details without_details(const LabelledMesh& part, const std::vector<char>& kept,
                                      double ball_mm, double least_mm, double height_mm);

}  // namespace meshwind
