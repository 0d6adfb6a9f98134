/// Even triangles over the smooth surface that a file's vertices stand for.
#pragma once

#include <vector>

#include "mesh/even/labelled_mesh.h"
#include "mesh/surface.h"

namespace meshwind {

struct EvenMeshOptions {
    double turn_rad = 0.1;  ///< by which the surface turns along an edge, where nothing else binds
    double least_mm = 0.0;  ///< edges are not made shorter than this,
    double most_turn = 0.35;   ///< unless the surface would turn by more than this,
    double shortest_mm = 0.0;  ///< and never shorter than this
    double longest_mm = 0.0;   ///< > 0
    std::vector<double> most_mm =
        {};                ///< the same per vertex of the wall; empty: nothing of that kind
    double grading = 0.2;  ///< by which edges grow per length of way, no unit
    int sweeps = 10;       ///< of split, collapse, flip and smooth
    int polish = 4;        ///< closing sweeps that only flip towards larger angles and smooth
};

/// Even triangles are no more than this. A pipe 100 times as long as wide takes 10,000; beyond,
/// vertices stand for no surface, and nobody waits for what comes of them.
inline constexpr double kMaxEvenTriangles = 200000.0;

/// Edges of a part of this size.
[[nodiscard]] EvenMeshOptions even_options(double size_mm);

/// How many triangles an even mesh of this wall has, about: by its area and the edges wanted there.
/// \param wall frozen
[[nodiscard]] double wanted_triangles(const Surface& wall, const EvenMeshOptions& options);

/// The wall of `part` in triangles of nearly equal edges, shorter where it is curved; every vertex
/// on a curved patch of the given wall (mesh/smooth/patch.h), or on the curve through the vertices
/// of a crease or of the wall's end. Corners of those lines stay. Faces that are no wall are halved
/// where an edge that they share with it is. The outcome depends on the input alone.
/// \param kept per region: whether it is wall \param wall frozen_wall() of both
/// \pre part is an oriented manifold, without slivers
/// Source: botsch_2004_remeshing, with sizes by curvature.
[[nodiscard]] LabelledMesh even_mesh(const LabelledMesh& part, const std::vector<char>& kept,
                                     Surface wall, const EvenMeshOptions& options);

}  // namespace meshwind
