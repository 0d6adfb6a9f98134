/// A small tube or a soup of triangles, spoilt in the ways that files are spoilt: holes, triangles
/// turned over or doubled, points moved far out or together, edges split on one side, new
/// triangles.
#pragma once

#include <cstdint>
#include <span>

#include "mesh/triangle_soup.h"

namespace meshwind::fuzz {

/// \return at least one triangle; indices name points, coordinates are finite
[[nodiscard]] TriangleSoup spoilt_mesh(std::span<const std::uint8_t> bytes);

}  // namespace meshwind::fuzz
