/// Isotropic remeshing onto a surface that is known exactly.
#pragma once

#include <functional>

#include "mesh/triangle_soup.h"

namespace meshwind {

struct RemeshOptions {
    double edge_mm = 5.0;  ///< > 0; edges between 4/5 and 4/3 of it are left in peace
    int sweeps = 12;       ///< of split, collapse, flip and smooth; angles settle after about ten
    int polish = 6;        ///< closing sweeps that only flip towards larger angles and smooth
};

/// Triangles of nearly equal edges over the same surface, every inner vertex a value of `project`.
/// Boundary vertices and edges stay as they are. The outcome depends on the input alone.
/// \param soup manifold and oriented, vertices on the surface
/// \param project nearest point of the exact surface to a point near it
/// Source: M. Botsch, L. Kobbelt, A remeshing approach to multiresolution modeling, SGP 2004, with
/// uniform smoothing.
[[nodiscard]] TriangleSoup remesh_onto(
    const TriangleSoup& soup, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& project,
    const RemeshOptions& options);

}  // namespace meshwind
