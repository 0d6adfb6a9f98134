/// Finds self-intersections of a mesh (CGAL).
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Faces that cross or overlap another beyond shared vertices and edges, ascending. Exact
/// decisions.
/// \pre soup is an oriented manifold
[[nodiscard]] std::vector<std::int32_t> self_intersecting_faces(const TriangleSoup& soup);

}  // namespace meshwind
