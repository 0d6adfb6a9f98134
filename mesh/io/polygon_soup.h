/// Points and polygons as files hold them, and the triangulation of polygons.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// A polygon with more corners is refused: no surface of a part has one, and splitting it takes the
/// square of their number.
constexpr std::size_t kMaxCorners = 1000;

struct PolygonSoup {
    std::vector<Eigen::Vector3d> points;  ///< n x 3, file units
    std::vector<std::int32_t> corners;    ///< point indices of all polygons, one after the other
    std::vector<std::size_t> ends;        ///< per polygon: where its corners end in `corners`
};

/// Message of mesh.large_polygon.
[[nodiscard]] std::string large_polygon_words();

/// Message of mesh.bad_index. \param index as the file counts, from `first`
[[nodiscard]] std::string bad_index_words(std::int64_t index, std::int64_t first,
                                          std::size_t point_count);

/// Triangles of the polygons in their order, each turning as its polygon does. Polygons that are
/// not convex are split by cutting off ears in the plane of their mean normal; one that crosses
/// itself is covered somehow. Polygons of one or two corners have no surface and give none.
/// Cost: the square of a polygon's corners.
/// \pre corners name points; polygons have at most kMaxCorners corners \throws Interrupted
[[nodiscard]] TriangleSoup triangles_of(PolygonSoup&& polygons);

}  // namespace meshwind
