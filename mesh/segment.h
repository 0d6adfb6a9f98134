/// Which part of a file's surface is wound: smooth regions and what each of them is.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/mandrel.h"

namespace meshwind {

struct Segmentation {
    std::vector<Region> regions;                       ///< by area, largest first; id = index
    std::vector<std::int32_t> region;                  ///< per face
    std::vector<std::array<std::uint8_t, 3>> feature;  ///< per face and edge, see feature_edges.h
    std::vector<std::array<std::int32_t, 3>> neighbours;  ///< per face and edge, see edge_table.h
};

/// Regions are bounded by feature edges. An end cap is a planar region whose edges are all convex,
/// so nothing stands before it, and as large as the part's other ends: a disc or an annulus. What
/// the caps separate is one piece: the pieces that mostly see the outside are outer wall with all
/// their collars, chamfers and lettering; the others, and large regions that see nothing, are bore.
/// `kept` is set on the outer wall. Visibility is sampled, with a fixed number of rays for any
/// mesh. \pre soup is an oriented manifold with the outside in front (see repair.h)
[[nodiscard]] Segmentation segment(const TriangleSoup& soup);

}  // namespace meshwind
