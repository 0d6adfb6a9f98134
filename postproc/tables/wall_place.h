/// Nearest place of a wall to a point.
#pragma once

#include <Eigen/Core>

#include "geodesic/field_walk.h"
#include "mesh/ray_query.h"
#include "mesh/surface.h"

namespace meshwind {

/// On the curved patches. \param facets those of the wall \param point_mm finite
[[nodiscard]] FieldWalker wall_place(const Surface& wall, const RayQuery& facets,
                                     const Eigen::Vector3d& point_mm);

}  // namespace meshwind
