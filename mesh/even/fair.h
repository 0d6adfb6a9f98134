/// Fairing of free vertices and smooth filling of holes in a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Moves the free vertices onto the surface of least bending (the bi-Laplacian of the position
/// vanishes) that goes on smoothly from the triangles of the others.
/// \param free per point of the soup \return false where the faces are no manifold or the system
/// has no solution; the soup is then as it was. Source: botsch_2004_modeling, as CGAL has it.
[[nodiscard]] bool fair(TriangleSoup& soup, const std::vector<char>& free);

/// Fills a hole of the mesh with such a surface: new points and faces follow the given ones.
/// \param edge_from, edge_to points of an edge of a face, from the one to the other in that face's
/// order, on the hole's border \return false as above, also where the edge is on no border
[[nodiscard]] bool fill_hole(TriangleSoup& soup, std::int32_t edge_from, std::int32_t edge_to);

}  // namespace meshwind
