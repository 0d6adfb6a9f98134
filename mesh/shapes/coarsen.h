/// Coarsens a mesh by edge collapses (decimation), without knowing the surface.
#pragma once

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Collapses edges, shortest first, until the mean edge is about `edge_mm` long. Every remaining
/// point is one of the given ones, so nothing leaves the surface; rims stay on rims and creases
/// (feature_edges.h) on creases. A collapse is not made where the given facets around the removed
/// point turn by more than the crease angle, or where it leaves a worse sliver than before: sharply
/// curved places stay finer. The outcome depends on the input alone. \pre soup is manifold and
/// oriented; edge_mm > 0
[[nodiscard]] TriangleSoup coarsened(const TriangleSoup& soup, double edge_mm);

}  // namespace meshwind
