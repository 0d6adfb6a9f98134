/// Welds the copies of a point that files hold per face or per object.
#pragma once

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Near points of open borders are joined up to this share of the bounding box's diagonal: ten
/// times the rounding of single precision, a tenth of the smallest slivers seen in CAD exports (a
/// weld of 1e-5 would destroy a fifth of the triangles of some).
inline constexpr double kBorderWeldShare = 1e-6;

struct WeldReport {
    int welded_points = 0;   ///< points that became another point's copy
    int edges_stitched = 0;  ///< pairs of open edges closed by joining near points
};

/// Joins points with equal coordinates, then near points at open borders, nearest pairs first, and
/// never two points of one face. Order of the points: first appearance. Points that no face uses
/// are dropped. Faces keep their order; those whose points coincide exactly stay, degenerate.
WeldReport weld(TriangleSoup& soup);

}  // namespace meshwind
