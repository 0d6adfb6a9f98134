/// Refines a mesh over the smooth surface that it approximates.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/surface.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// Limit of the number of triangles: a file of 500 MB.
inline constexpr std::size_t kMaxRefinedFaces = 10'000'000;

/// A mesh with the data of its faces, as `freeze_surface` takes it. Mandrel frame.
struct RefinedMesh {
    TriangleSoup soup;
    std::vector<std::array<std::uint8_t, 3>> feature;
    std::vector<std::int32_t> region;
    std::vector<std::array<std::int32_t, 3>> rim;

    [[nodiscard]] Surface frozen() const;
};

/// Halves edges until none is longer than `edge_mm`: each triangle becomes two, three or four by
/// the number of its edges that are too long. The mesh stays conforming and is fine only where it
/// must be. The given vertices stay; new ones lie on the curved patch of the triangle that they
/// come from (mesh/smooth/patch.h), on rims on the curve through the rim's vertices. Feature edges,
/// rims and regions are kept. The same surface gives the same mesh. Accuracy: new vertices on
/// smooth surfaces are off by the fourth order in the edge length or better
/// (tests/mesh/smooth/refine_test.cpp). \throws InputError refine.not_positive; refine.too_many
/// above kMaxRefinedFaces triangles
[[nodiscard]] RefinedMesh refined(const Surface& surface, double edge_mm);

}  // namespace meshwind
