/// Marks shallow creases of bodies of revolution as feature edges.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/revolution/revolution.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// Marks as features the edges that lie on a crease of the meridian, where these make a full
/// circle. The meridian shows a cone on a cylinder to be sharp at angles far below
/// `kFeatureAngleRad`, the limit for single edges. Kinks of less than a degree stay smooth, and so
/// do creases that the triangles' edges do not follow.
/// \param soup, feature per face, of the mandrel's surface in its frame
/// \return whether any edge was marked
[[nodiscard]] bool mark_crease_rings(const BodyOfRevolution& body, const TriangleSoup& soup,
                                     std::span<std::array<std::uint8_t, 3>> feature);

}  // namespace meshwind
