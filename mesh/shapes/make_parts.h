/// Building blocks of made meshes: rows of vertices and the triangles between them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/index.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

using VertexRow = std::vector<std::int32_t>;

/// length / step rounded, but at least `least`.
[[nodiscard]] std::int32_t steps_of(double length_mm, double step_mm, std::int32_t least);

/// Distance between rows of equilateral triangles of this edge.
[[nodiscard]] double row_step_mm(double edge_mm);

/// Length along a curve over its parameters 0 to pi / 2, by a table of chords.
class QuarterLengths {
public:
    explicit QuarterLengths(const std::function<Eigen::Vector3d(double)>& place_mm);

    [[nodiscard]] double whole_mm() const { return length_mm_.back(); }
    /// The parameter up to which the curve has this length.
    [[nodiscard]] double parameter(double length_mm) const;

private:
    std::vector<double> length_mm_;  // at even steps of the parameter
};

/// Triangles between two rows by the shorter diagonal each time; `upper` lies left of `lower`'s
/// direction seen from outside, both run the same way. Rows of one vertex make a fan.
void stitch_open(TriangleSoup& soup, const VertexRow& lower, const VertexRow& upper);

/// The same between two rings; the last vertex of each is followed by its first.
void stitch_rings(TriangleSoup& soup, const VertexRow& lower, VertexRow upper);

/// The boundary loops in the direction of the faces' half-edges, ordered by their least vertex,
/// which comes first. \pre soup is manifold and oriented
[[nodiscard]] std::vector<VertexRow> boundary_loops(const TriangleSoup& soup);

/// Outer wall, inner wall turned over, and a face between each rim and the nearest rim inside: a
/// watertight solid, or two closed walls when there are no rims. Faces between rims have one row of
/// triangles, as CAD tessellates them. \pre both walls face outward and have equally many rims
[[nodiscard]] TriangleSoup shell_between(const TriangleSoup& outer, const TriangleSoup& inner);

}  // namespace meshwind
