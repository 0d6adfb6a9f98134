/// Makes the mesh to be wound: the program's own, where the file's is uneven.
#pragma once

#include <optional>
#include <vector>

#include "mesh/even/labelled_mesh.h"
#include "mesh/winding_mesh_report.h"

namespace meshwind {

/// A mesh is uneven if a triangle of its wall is below this quality (shape_quality): a triangle of
/// 1 : 11, which no mesher makes of its own accord.
inline constexpr double kUnevenQuality = 0.15;

/// Largest distance of a vertex of the file from our own mesh's surface, as a share of the part's
/// size (the radius of the ball with the wall's area); above it the own mesh is rejected. It is
/// 0.2 mm on a pipe of 50 mm: less than a blind letter stands out, more than facets are off.
inline constexpr double kDeviationShare = 2e-3;

struct WindingMesh {
    LabelledMesh part;  ///< the given one where the report says so
    WindingMeshReport report;
    TriangleSoup removed;  ///< removed details, in the given triangles
};

/// Where the wall has narrow triangles: long facets are halved on their cylinders and cones
/// (long_facets.h), slivers (slivers.h) and lettering (details.h) are removed, and the smooth
/// surface through the remaining vertices is remeshed evenly (even_mesh.h), with shorter edges
/// where triangles would be too far off the given vertices. The given mesh stays where the result
/// is not even or not near them.
/// \param kept per region: whether it is wall \param part oriented manifold, mm
/// \param details_mm height up to which details are removed, also from even walls; none: of
/// lettering, 1 mm; 0: none are
[[nodiscard]] WindingMesh winding_mesh(const LabelledMesh& part, const std::vector<char>& kept,
                                       const std::optional<double>& details_mm = {});

}  // namespace meshwind
