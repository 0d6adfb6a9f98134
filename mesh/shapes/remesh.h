/// Isotropic remeshing onto a surface that is known exactly, and random roughening of a mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/triangle_soup.h"

namespace meshwind {

struct RemeshOptions {
    double edge_mm = 5.0;  ///< > 0; edges between 4/5 and 4/3 of it are left alone
    int sweeps = 12;       ///< of split, collapse, flip and smooth; angles settle after about ten
    int polish = 6;        ///< closing sweeps that only flip towards larger angles and smooth
};

/// Triangles of nearly equal edges over the same surface, every inner vertex a value of `project`.
/// Boundary vertices and edges stay as they are. The outcome depends on the input alone.
/// \param soup manifold and oriented, vertices on the surface
/// \param project nearest point of the exact surface to a point near it
/// Source: botsch_2004_remeshing, with uniform smoothing.
[[nodiscard]] TriangleSoup remesh_onto(
    const TriangleSoup& soup, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& project,
    const RemeshOptions& options);

struct RoughenOptions {
    double edge_mm = 5.0;  ///< > 0; edge length of the mesh
    double jitter =
        0.3;  ///< largest shift of a vertex in edges; more makes few vertices able to move
    double min_angle_rad = 0.3;  ///< shifts and flips that leave a smaller angle are not made
    double max_edge = 2.0;       ///< nor a longer edge, in edges
    std::uint64_t seed = 1;
};

/// Shifts the inner vertices at random along the surface and turns every second edge between two
/// triangles: no regularity is left for errors to cancel in. Boundary vertices and edges stay.
/// \param fixed per vertex, 1: stays, as do edges between two such; empty: all inner vertices may
/// move
[[nodiscard]] TriangleSoup roughen_onto(
    const TriangleSoup& soup, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& project,
    const std::vector<std::uint8_t>& fixed, const RoughenOptions& options);

}  // namespace meshwind
