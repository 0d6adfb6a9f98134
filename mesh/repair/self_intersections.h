/// Faces that cross others (CGAL).
#pragma once

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Number of faces that cross or overlap another beyond what they share. Exact decisions.
/// \pre soup is an oriented manifold
[[nodiscard]] int count_self_intersecting_faces(const TriangleSoup& soup);

}  // namespace meshwind
