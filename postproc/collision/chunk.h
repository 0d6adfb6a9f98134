/// Convex pieces of machine parts, and the distance between two of them.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "machines/machine.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// A segment (two corners) or a triangle, thickened by a radius.
struct Chunk {
    std::array<Eigen::Vector3d, 3> corner;
    int corners = 2;
    double radius_mm = 0.0;

    [[nodiscard]] Eigen::Vector3d centre() const;
    /// Largest distance of a corner from the centre.
    [[nodiscard]] double reach_mm() const;
    /// Cut across its longest side.
    [[nodiscard]] std::array<Chunk, 2> halves() const;
    [[nodiscard]] Chunk moved(const Eigen::Isometry3d& motion) const;
};

[[nodiscard]] Chunk chunk_of(const Capsule& capsule);
[[nodiscard]] std::vector<Chunk> chunks_of(const TriangleSoup& triangles);

/// Least distance of two segments, of a point and a triangle.
[[nodiscard]] double segment_distance_mm(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1,
                                         const Eigen::Vector3d& b0, const Eigen::Vector3d& b1);
[[nodiscard]] double triangle_distance_mm(const Eigen::Vector3d& point,
                                          const std::array<Eigen::Vector3d, 3>& triangle);

/// Least distance between two pieces, less both radii: negative where they overlap, at least
/// minus their sum. In closed form.
[[nodiscard]] double chunk_distance_mm(const Chunk& a, const Chunk& b);

/// A closed triangle mesh around a capsule: it contains the capsule and sticks out by at most
/// `outside_mm` (radii up to 5 m), so distances to it are less than to the capsule by as much.
[[nodiscard]] TriangleSoup capsule_mesh(const Capsule& capsule, double outside_mm);

}  // namespace meshwind
