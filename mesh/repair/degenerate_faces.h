/// Removal of faces without area that keeps the surface closed.
#pragma once

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Collapses needles and flips or cuts off caps lower than `height_mm` over their longest edge.
/// \return number of degenerate faces found, all of which are gone \pre soup is an oriented
/// manifold
int remove_degenerate_faces(TriangleSoup& soup, double height_mm);

}  // namespace meshwind
