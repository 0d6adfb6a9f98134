/// A surface frozen straight from triangles, for tests: creases and rims as the import finds them.
#pragma once

#include <vector>

#include "mesh/edge_table.h"
#include "mesh/segment/feature_edges.h"
#include "mesh/segment/rims.h"
#include "mesh/smooth/freeze.h"
#include "mesh/surface.h"

namespace meshwind::test {

inline Surface frozen(const TriangleSoup& soup) {
    const auto neighbours = face_neighbours(soup.faces);
    const auto feature = feature_edges(soup, steady_normals(soup, neighbours), neighbours);
    const Rims rims = find_rims(soup);
    const std::vector<std::int32_t> region(soup.faces.size(), 0);
    return freeze_surface(soup, {.feature = feature, .region = region, .rim = rims.of_edge});
}

}  // namespace meshwind::test
