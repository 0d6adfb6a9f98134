/// Triangle quality, and removal of slivers from a wall.
#pragma once

#include <vector>

#include "mesh/even/labelled_mesh.h"

namespace meshwind {

/// 1 for an equilateral triangle, 0 for one without area: 4 sqrt(3) area over the sum of the
/// squared sides. Source: bhatia_1990_shape.
[[nodiscard]] double shape_quality(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const Eigen::Vector3d& c);

/// The least quality of a triangle; 1 where there is none.
[[nodiscard]] double least_quality(const TriangleSoup& soup);
/// The same among the wall's triangles.
[[nodiscard]] double least_quality(const LabelledMesh& part, const std::vector<char>& kept);

/// Share of the wall's area in triangles below a quality.
[[nodiscard]] double share_below(const LabelledMesh& part, const std::vector<char>& kept,
                                 double quality);

/// Removes narrow triangles of the wall as far as edge collapses and flips can: every remaining
/// vertex is one of the given ones. Short edges of narrow triangles collapse where they are below
/// `short_mm` and the removed vertex is at most `off_mm` from the remaining triangles; long ones
/// between nearly coplanar facets flip. Lines stay lines. The outcome depends on the input alone.
[[nodiscard]] LabelledMesh without_slivers(const LabelledMesh& part, const std::vector<char>& kept,
                                           double short_mm, double off_mm);

}  // namespace meshwind
