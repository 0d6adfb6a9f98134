/// Repairs welded triangles to an oriented manifold with its outside in front.
#pragma once

#include <string>

#include "mesh/repair_report.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// A face lower than this share of the bounding box's diagonal over its longest edge is degenerate:
/// ten thousand times the rounding of double precision, far below what single precision can hold.
inline constexpr double kDegenerateHeightShare = 1e-12;

/// Makes `soup` an oriented manifold: drops degenerate and duplicate faces without opening the
/// surface, pairs the faces at edges with more than two (by their angle around the edge where that
/// is clear, else the edge is cut), turns faces to agree with the majority of their component, then
/// each component outward (closed: by volume; open: the side that sees more of the outside), splits
/// vertices that hold several fans. Faces that cross others are counted, not changed.
/// \param soup welded (see weld.h) \param name place for error messages
/// \throws InputError mesh.no_triangles_left, mesh.not_orientable
void repair(TriangleSoup& soup, const std::string& name, RepairReport& report);

/// Gives each fan of faces around a vertex its own copy of the vertex, as is needed after faces
/// were removed. New copies follow the old points. \return number of copies made
int split_vertex_fans(TriangleSoup& soup);

}  // namespace meshwind
