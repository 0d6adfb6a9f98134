/// Parametric mandrels as triangles: `meshwind make` and the meshes of the accuracy studies.
#pragma once

#include <cstdint>

#include "mesh/shapes.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

struct MakeOptions {
    double edge_mm = 5.0;  ///< > 0; edge length aimed at
};

/// The tee's outer surface: a manifold with three rims, which are exact circles; every vertex lies
/// on the ideal surface (tee_foot) to rounding, edges do not follow the contact curves. \throws
/// InputError what TeeShape::validate throws, make.not_positive, make.edge_too_large
[[nodiscard]] TriangleSoup make_tee(const TeeShape& shape, const MakeOptions& options = {});

}  // namespace meshwind
