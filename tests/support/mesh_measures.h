/// What the tests of made meshes look at: topology, orientation, edges and angles.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "core/units.h"
#include "mesh/triangle_soup.h"

namespace meshwind::test {

struct MeshMeasures {
    bool oriented_manifold = true;  ///< every half-edge once, every used vertex one fan
    int euler = 0;
    int rims = 0;
    double volume_mm3 = 0.0;  ///< divergence sum: the enclosed volume of a closed mesh
    double min_edge_mm = std::numeric_limits<double>::max();
    double max_edge_mm = 0.0;
    double min_angle_deg = 180.0;
};

inline const Eigen::Vector3d& point_of(const TriangleSoup& soup, std::int32_t id) {
    return soup.points_mm[static_cast<std::size_t>(id)];
}

inline void measure_shape(const TriangleSoup& soup, MeshMeasures& measures) {
    for (const auto& face : soup.faces) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Eigen::Vector3d& a = point_of(soup, face[i]);
            const Eigen::Vector3d ab = point_of(soup, face[(i + 1) % 3]) - a;
            const Eigen::Vector3d ac = point_of(soup, face[(i + 2) % 3]) - a;
            measures.min_edge_mm = std::min(measures.min_edge_mm, ab.norm());
            measures.max_edge_mm = std::max(measures.max_edge_mm, ab.norm());
            measures.min_angle_deg = std::min(
                measures.min_angle_deg, deg_from_rad(std::atan2(ab.cross(ac).norm(), ab.dot(ac))));
        }
        measures.volume_mm3 +=
            point_of(soup, face[0]).dot(point_of(soup, face[1]).cross(point_of(soup, face[2]))) /
            6.0;
    }
}

inline MeshMeasures measure(const TriangleSoup& soup) {
    MeshMeasures measures;
    measure_shape(soup, measures);
    std::set<std::pair<std::int32_t, std::int32_t>> halves;
    std::map<std::int32_t, int> faces_at;
    for (const auto& face : soup.faces) {
        for (std::size_t i = 0; i < 3; ++i) {
            measures.oriented_manifold &= halves.insert({face[i], face[(i + 1) % 3]}).second;
            ++faces_at[face[i]];
        }
    }
    std::map<std::int32_t, std::int32_t> rim_next;
    for (const auto& [a, b] : halves) {
        if (!halves.contains({b, a})) {
            measures.oriented_manifold &= rim_next.insert({a, b}).second;
        }
    }
    // One fan per vertex: edges at it = faces at it, plus one on a rim.
    std::map<std::int32_t, std::set<std::int32_t>> neighbours;
    for (const auto& [a, b] : halves) {
        neighbours[a].insert(b);
        neighbours[b].insert(a);
    }
    for (const auto& [vertex, near] : neighbours) {
        measures.oriented_manifold &=
            static_cast<int>(near.size()) == faces_at[vertex] + (rim_next.contains(vertex) ? 1 : 0);
    }
    measures.oriented_manifold &= neighbours.size() == soup.points_mm.size();
    const std::size_t edges = (halves.size() + rim_next.size()) / 2;
    measures.euler = static_cast<int>(soup.points_mm.size()) - static_cast<int>(edges) +
                     static_cast<int>(soup.faces.size());
    std::set<std::int32_t> seen;
    for (const auto& [start, next] : rim_next) {
        measures.rims += seen.contains(start) ? 0 : 1;
        for (std::int32_t at = start; rim_next.contains(at) && seen.insert(at).second;) {
            at = rim_next[at];
        }
    }
    return measures;
}

inline std::set<std::int32_t> rim_vertices(const TriangleSoup& soup) {
    std::set<std::pair<std::int32_t, std::int32_t>> halves;
    for (const auto& [a, b, c] : soup.faces) {
        halves.insert({{a, b}, {b, c}, {c, a}});
    }
    std::set<std::int32_t> vertices;
    for (const auto& [a, b] : halves) {
        if (!halves.contains({b, a})) {
            vertices.insert({a, b});
        }
    }
    return vertices;
}

}  // namespace meshwind::test
