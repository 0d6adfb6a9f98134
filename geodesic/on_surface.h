/// Position and smooth normal of a surface point.
#pragma once

#include <Eigen/Core>

#include "geodesic/surface_path.h"
#include "mesh/surface.h"

namespace meshwind {

/// Position of a surface point on its facet.
[[nodiscard]] inline Eigen::Vector3d position_mm(const Surface& surface,
                                                 const SurfacePoint& point) {
    const auto& [a, b, c] = surface.face[static_cast<std::size_t>(point.face)];
    return point.bary[0] * surface.position_mm[static_cast<std::size_t>(a)] +
           point.bary[1] * surface.position_mm[static_cast<std::size_t>(b)] +
           point.bary[2] * surface.position_mm[static_cast<std::size_t>(c)];
}

/// Smooth outward unit normal at a surface point, interpolated from the face's corners.
[[nodiscard]] Eigen::Vector3d smooth_normal(const Surface& surface, const SurfacePoint& point);

}  // namespace meshwind
