/// Constrained Delaunay triangulation of points in the plane.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// Triangles of the points' convex hull that contain every constrained segment as an edge.
/// \param points n x 2, pairwise different \param constraints pairs of point indices; they may
/// share end points but not cross \return m x 3 point indices, counter-clockwise; the same for the
/// same input
[[nodiscard]] std::vector<std::array<std::int32_t, 3>> planar_delaunay(
    std::span<const Eigen::Vector2d> points,
    std::span<const std::array<std::int32_t, 2>> constraints);

}  // namespace meshwind
