/// A smooth surface where some vertices of a mesh are free.
#pragma once

#include <vector>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Moves the free vertices onto the surface of least bending (the bi-Laplacian of the position
/// vanishes) that goes on smoothly from the triangles of the others.
/// \param free per point of the soup \return false where the faces are no manifold or the system
/// has no solution; the soup is then as it was. Source: botsch_2004_modeling, as CGAL has it.
[[nodiscard]] bool fair(TriangleSoup& soup, const std::vector<char>& free);

}  // namespace meshwind
