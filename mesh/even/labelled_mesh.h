/// Triangles with what segmentation found of them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Arrays per face are as long as `soup.faces`.
struct LabelledMesh {
    TriangleSoup soup;
    std::vector<std::int32_t> region;                  ///< per face
    std::vector<std::array<std::uint8_t, 3>> feature;  ///< per face and edge: 1 on a crease
};

}  // namespace meshwind
