/// A part's triangles with what segmentation found of them, for the tests of mesh/even.
#pragma once

#include <vector>

#include "mesh/even/labelled_mesh.h"
#include "mesh/segment/segment.h"

namespace meshwind::test {

struct Walls {
    LabelledMesh part;
    std::vector<char> kept;  ///< per region: whether it is wall
};

inline Walls walls_of(const TriangleSoup& soup) {
    const Segmentation s = segment(soup);
    Walls walls{{soup, s.region, s.feature}, {}};
    for (const Region& region : s.regions) {
        walls.kept.push_back(static_cast<char>(region.kept));
    }
    return walls;
}

}  // namespace meshwind::test
