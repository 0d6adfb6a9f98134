/// Isotropic remeshing of a wall over the smooth surface through its vertices.
#pragma once

#include <vector>

#include "mesh/even/labelled_mesh.h"
#include "mesh/surface.h"

namespace meshwind {

struct EvenMeshOptions {
    double turn_rad = 0.1;     ///< turn of the surface along an edge, where no other limit binds
    double least_mm = 0.0;     ///< edges are not made shorter than this,
    double most_turn = 0.35;   ///< unless the surface would turn by more than this,
    double shortest_mm = 0.0;  ///< and never shorter than this
    double longest_mm = 0.0;   ///< > 0
    std::vector<double> most_mm =
        {};                ///< longest edge per vertex of the wall; empty: no such limit
    double grading = 0.2;  ///< growth of edges per length of path, no unit
    int sweeps = 10;       ///< of split, collapse, flip and smooth
    int polish = 4;        ///< closing sweeps that only flip towards larger angles and smooth
};

/// Limit of the number of even triangles. A pipe 100 times as long as wide takes 10,000; beyond the
/// limit vertices represent no surface, and the run takes too long to be of use.
inline constexpr double kMaxEvenTriangles = 200000.0;

/// Edge lengths for a part of this size.
[[nodiscard]] EvenMeshOptions even_options(double size_mm);

/// Estimated number of triangles of an even mesh of this wall, by its area and the wanted edges.
/// \param wall frozen
[[nodiscard]] double wanted_triangles(const Surface& wall, const EvenMeshOptions& options);

/// Remeshes the wall of `part` with nearly equal edges, shorter where it is curved; every vertex
/// lies on a curved patch of the given wall (mesh/smooth/patch.h), or on the curve through the
/// vertices of a crease or of the wall's end. Corners of those lines stay. Faces off the wall are
/// halved where an edge shared with it is. The outcome depends on the input alone.
/// \param kept per region: whether it is wall \param wall frozen_wall() of both
/// \pre part is an oriented manifold, without slivers
/// Source: botsch_2004_remeshing, with sizes by curvature.
[[nodiscard]] LabelledMesh even_mesh(const LabelledMesh& part, const std::vector<char>& kept,
                                     Surface wall, const EvenMeshOptions& options);

}  // namespace meshwind
