/// One wall of each shape, without regard to solids or irregular meshes.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/shapes/profile.h"
#include "mesh/shapes/shapes.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// A wall with the vertices that lie on its sharp rings.
struct MadeWall {
    TriangleSoup soup;
    std::vector<std::uint8_t> sharp;  ///< per vertex, 1 on a sharp ring; empty: none
};

/// Rings of nearly equilateral triangles around z. \pre edge_mm is small against the profile
[[nodiscard]] MadeWall wall_of(const Profile& profile, double edge_mm);

/// Strips along the pipe, half a right-angled grid on the bend, equilateral on the legs.
[[nodiscard]] MadeWall wall_of(const ElbowShape& shape, double edge_mm);

/// Closed torus: rings around z; open: strips as for the elbow.
[[nodiscard]] MadeWall wall_of(const TorusShape& shape, double edge_mm);

/// See make_tee.
[[nodiscard]] MadeWall wall_of(const TeeShape& shape, double edge_mm);

}  // namespace meshwind
