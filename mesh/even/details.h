/// Lettering, logos and specks on a wall, which are not wound.
#pragma once

#include <vector>

#include "mesh/even/labelled_mesh.h"

namespace meshwind {

struct Details {
    LabelledMesh part;      ///< the given one where nothing was taken off
    TriangleSoup removed;   ///< what was, in the given triangles
    int count = 0;          ///< letters that hang together count once
    double area_mm2 = 0.0;  ///< of the given triangles
    double most_mm = 0.0;   ///< the farthest that one stood out of the wall, or went into it
};

/// Takes off what stands out of the wall, or goes into it, by no more than `height_mm`, is
/// surrounded by wall, and is so narrow that a ball of `ball_mm` rolling on the other side does not
/// fill it, with what it encloses. The wall goes on smoothly over its place. What goes around a
/// leg, reaches an end or takes a twentieth of the wall is no detail, nor what is too low to tell
/// from the wall's own unevenness (`least_mm`).
/// \param kept per region: whether it is wall \pre part is an oriented manifold, without slivers
[[nodiscard]] Details without_details(const LabelledMesh& part, const std::vector<char>& kept,
                                      double ball_mm, double least_mm, double height_mm);

}  // namespace meshwind
