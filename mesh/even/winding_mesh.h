/// The mesh that is wound: the program's own, where the file's is uneven.
#pragma once

#include <optional>
#include <vector>

#include "mesh/even/labelled_mesh.h"
#include "mesh/winding_mesh_report.h"

namespace meshwind {

/// Below this quality of a triangle (shape_quality) of its wall a mesh is uneven: a triangle of
/// 1 : 11, as no mesher of its own accord makes one.
inline constexpr double kUnevenQuality = 0.15;

/// A mesh of our own that leaves a vertex of the file's farther from its surface than this share of
/// the part's size (the radius of the ball with the wall's area) is not taken: 0.2 mm on a pipe of
/// 50 mm, less than a blind letter stands out, more than facets are off.
inline constexpr double kDeviationShare = 2e-3;

struct WindingMesh {
    LabelledMesh part;  ///< the given one where the report says so
    WindingMeshReport report;
    TriangleSoup removed;  ///< what was taken off as a detail, in the given triangles
};

/// Where the wall has narrow triangles: long facets are halved on their cylinders and cones
/// (long_facets.h), slivers go (slivers.h), lettering is taken off (details.h), and even triangles
/// are laid over the smooth surface through the vertices that are left (even_mesh.h), with shorter
/// edges where they would be too far off the given vertices. Where that does not come out even and
/// near them, the given mesh stays.
/// \param kept per region: whether it is wall \param part oriented manifold, mm
/// \param details_mm height up to which details are taken off, also from even walls; none: of
/// lettering, 1 mm; 0: none are
[[nodiscard]] WindingMesh winding_mesh(const LabelledMesh& part, const std::vector<char>& kept,
                                       const std::optional<double>& details_mm = {});

}  // namespace meshwind
