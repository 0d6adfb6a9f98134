/// Finds the rims of the winding surface: boundary loops and the circles they lie on.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/rim.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// A loop smaller than this share of the largest is a hole in the wall, not an end.
inline constexpr double kRimRadiusShare = 0.1;

struct Rims {
    std::vector<Rim> rims;                             ///< by their first face, id = index
    std::vector<std::array<std::int32_t, 3>> of_edge;  ///< rim id per face and edge, else -1
    std::vector<Eigen::Vector3d> holes_mm;             ///< centres of loops too small to be rims
};

/// Loops run counter-clockwise seen along `Rim::axis` from outside. The circle is a least-squares
/// fit in the loop's plane with each vertex weighted by the boundary length beside it, so uneven
/// spacing does not pull; points far off it, in notches, are left out of the fit but not of the
/// circularity, which counts the middles of edges longer than the radius, too. Accuracy: exact to
/// rounding on a loop of points on a circle (tests/mesh/segment/rims_test.cpp). \pre soup is an
/// oriented manifold, one fan per vertex
[[nodiscard]] Rims find_rims(const TriangleSoup& soup);

/// The circle of one loop of vertices, in its order, as `find_rims` fits it.
[[nodiscard]] Rim rim_through(const TriangleSoup& soup, std::vector<std::int32_t> loop);

/// Distance of a point from the rim's circle.
[[nodiscard]] double off_circle_mm(const Rim& rim, const Eigen::Vector3d& point);

}  // namespace meshwind
