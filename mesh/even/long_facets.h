/// Subdivides long facets along the rulings of cylinders and cones, as CAD programs make them from
/// end to end.
#pragma once

#include <vector>

#include "mesh/even/labelled_mesh.h"
#include "mesh/even/wall_shapes.h"

namespace meshwind {

struct LongFacets {
    LabelledMesh part;         ///< with long facets halved until they are short
    int shapes = 0;            ///< exact ones, and cylinders and cones of rows of facets
    int halved = 0;            ///< edges that were halved
    double residual_mm = 0.0;  ///< largest distance of a vertex from its shape
};

/// Halves edges above `edge_mm` of two kinds of facets: those on one exact plane, cylinder or cone,
/// and those several times as long as high that lie with their neighbours on one cylinder or cone
/// as nearly as facets do. The new vertices lie on it. Other facets stay, as do lines, except
/// straight creases between exact shapes. \param kept per region: whether it is wall \param exact
/// shapes that `part.shape` names
[[nodiscard]] LongFacets halve_long_facets(const LabelledMesh& part, const std::vector<char>& kept,
                                           double edge_mm,
                                           const std::vector<WallShape>& exact = {});

}  // namespace meshwind
