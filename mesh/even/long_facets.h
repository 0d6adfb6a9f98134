/// Long facets along the rulings of cylinders and cones, of which CAD programs make one row from
/// end to end.
#pragma once

#include <vector>

#include "mesh/even/labelled_mesh.h"

namespace meshwind {

struct LongFacets {
    LabelledMesh part;         ///< with long facets halved until they are short
    int shapes = 0;            ///< cylinders and cones that were found
    int halved = 0;            ///< edges that were halved
    double residual_mm = 0.0;  ///< largest distance of a vertex from its cylinder or cone
};

/// Halves edges above `edge_mm` of the facets that are several times as long as high and lie with
/// those beside them on one cylinder or cone, by its vertices: the new vertices lie on that
/// exactly. Other facets stay, as do lines. \param kept per region: whether it is wall
[[nodiscard]] LongFacets halve_long_facets(const LabelledMesh& part, const std::vector<char>& kept,
                                           double edge_mm);

}  // namespace meshwind
