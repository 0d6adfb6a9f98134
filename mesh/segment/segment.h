/// Segments a file's surface into smooth regions: outer wall (which is wound), end caps, bore.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/region.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

struct Segmentation {
    std::vector<Region> regions;                       ///< by area, largest first; id = index
    std::vector<std::int32_t> region;                  ///< per face
    std::vector<std::array<std::uint8_t, 3>> feature;  ///< per face and edge, see feature_edges.h
    std::vector<std::array<std::int32_t, 3>> neighbours;  ///< per face and edge, see edge_table.h
    std::vector<std::int32_t> angular_ends;               ///< region ids, see end_caps.h
};

/// Regions are bounded by feature edges, and by flat ends (flat_ends.h). End caps: see end_caps.h.
/// Bore: large regions that see nothing and the blind ones beside them; pieces that lie in the
/// holes of end caps only; pieces that mostly see nothing. Where a notched end face or a round lip
/// lets wall and bore run together, they are parted halfway. The rest is outer wall with all its
/// collars, chamfers and lettering, and is `kept`. Visibility is sampled, with a bounded number of
/// rays per region. \pre soup is an oriented manifold with the outside in front (see repair.h)
[[nodiscard]] Segmentation segment(const TriangleSoup& soup);

}  // namespace meshwind
