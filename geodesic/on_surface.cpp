#include "geodesic/on_surface.h"

#include <cstddef>

namespace meshwind {

Eigen::Vector3d smooth_normal(const Surface& surface, const SurfacePoint& point) {
    const auto& corner = surface.corner[static_cast<std::size_t>(point.face)];
    return (point.bary[0] * surface.normal[static_cast<std::size_t>(corner[0])] +
            point.bary[1] * surface.normal[static_cast<std::size_t>(corner[1])] +
            point.bary[2] * surface.normal[static_cast<std::size_t>(corner[2])])
        .normalized();
}

}  // namespace meshwind
