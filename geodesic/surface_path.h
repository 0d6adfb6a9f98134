/// A point on the surface and a path over it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "mesh/surface.h"

namespace meshwind {

/// A point in a face by barycentric coordinates (sum 1, each >= -kBaryEps).
struct SurfacePoint {
    std::int32_t face = kNoFace;
    Eigen::Vector3d bary = Eigen::Vector3d::Constant(1.0 / 3.0);
};

/// One station of a path. Mandrel frame; all directions unit.
struct PathPoint {
    SurfacePoint at;
    Eigen::Vector3d position_mm;
    Eigen::Vector3d normal;   ///< smooth outward normal
    Eigen::Vector3d tangent;  ///< direction of travel, perpendicular to `normal`
    double s_mm = 0.0;        ///< arc length from the path's start
    double kn_per_mm = 0.0;   ///< normal curvature, > 0 where tension presses the fibre on
    double kg_per_mm = 0.0;   ///< geodesic curvature, > 0 to the left of travel seen from outside
};

using SurfacePath = std::vector<PathPoint>;

/// The cubic between two places with unit tangents, as long as their chord, beside a point.
struct CubicPlace {
    double share;  ///< of the chord, 0..1
    Eigen::Vector3d position_mm;
    Eigen::Vector3d tangent;  ///< unit
};

[[nodiscard]] inline CubicPlace beside(const Eigen::Vector3d& a_mm,
                                       const Eigen::Vector3d& a_tangent,
                                       const Eigen::Vector3d& b_mm,
                                       const Eigen::Vector3d& b_tangent,
                                       const Eigen::Vector3d& point_mm) {
    const Eigen::Vector3d chord = b_mm - a_mm;
    const double length = chord.norm();
    const double s = std::clamp((point_mm - a_mm).dot(chord) / (length * length), 0.0, 1.0);
    const double r = 1.0 - s;
    const Eigen::Vector3d in = length * a_tangent - chord;
    const Eigen::Vector3d out = chord - length * b_tangent;
    const Eigen::Vector3d bulge = r * in + s * out;
    return {s, a_mm + s * chord + s * r * bulge,
            (chord + (r - s) * bulge + s * r * (out - in)).normalized()};
}

/// Position of a surface point on its facet.
[[nodiscard]] inline Eigen::Vector3d position_mm(const Surface& surface,
                                                 const SurfacePoint& point) {
    const auto& [a, b, c] = surface.face[static_cast<std::size_t>(point.face)];
    return point.bary[0] * surface.position_mm[static_cast<std::size_t>(a)] +
           point.bary[1] * surface.position_mm[static_cast<std::size_t>(b)] +
           point.bary[2] * surface.position_mm[static_cast<std::size_t>(c)];
}

}  // namespace meshwind
