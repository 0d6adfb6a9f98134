/// Detects feature edges (creases): edges where the surface turns too sharply to be smooth.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/units.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// Dihedral (between facet normals) from which an edge is a crease: a pipe of twelve facets turns
/// by 30 deg at each and must stay round; mitres, chamfers of 45 deg and shoulders lie above.
inline constexpr double kFeatureAngleRad = rad_from_deg(34.0);

/// A face lower than this share of the bounding box's diagonal has no trustworthy normal: text
/// files of six digits carry noise of 1e-6, which tilts such a face by 3 deg or more.
inline constexpr double kSliverHeightShare = 2e-5;

/// Unit facet normals, except that slivers take over the normal of the sound face beyond their
/// longest edge: noise on a sliver then neither makes nor hides a crease.
/// \param neighbours see face_neighbours
[[nodiscard]] std::vector<Eigen::Vector3d> steady_normals(
    const TriangleSoup& soup, const std::vector<std::array<std::int32_t, 3>>& neighbours);

/// Per face and edge 1 where the dihedral of the steady normals reaches `kFeatureAngleRad`; open
/// edges are not creases, nor are a few such edges in a row that end or close inside the surface,
/// nor those around a sliver or two that one region surrounds: both are folds of facets too
/// coarse or too uneven for a round wall. Symmetric over each edge.
[[nodiscard]] std::vector<std::array<std::uint8_t, 3>> feature_edges(
    const TriangleSoup& soup, const std::vector<Eigen::Vector3d>& normals,
    const std::vector<std::array<std::int32_t, 3>>& neighbours);

}  // namespace meshwind
