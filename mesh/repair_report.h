/// Report of mesh repair: counts of what was changed.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// Changes made to the triangles by repair; every count is of elements changed.
struct RepairReport {
    int welded_points = 0;
    int degenerate_faces_removed = 0;
    int duplicate_faces_removed = 0;
    int faces_flipped = 0;
    int edges_stitched = 0;
    int non_manifold_vertices_split = 0;
    int self_intersecting_faces = 0;  ///< reported, not repaired
    int components = 0;
    std::vector<Eigen::Vector3d> crossings;  ///< middles of those faces, the file's frame and units
};

}  // namespace meshwind
