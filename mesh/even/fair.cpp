#include "mesh/even/fair.h"

#define CGAL_EIGEN3_ENABLED
#include <CGAL/Polygon_mesh_processing/fair.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

namespace meshwind {

bool fair(TriangleSoup& soup, const std::vector<char>& free) {
    using Point = CGAL::Simple_cartesian<double>::Point_3;
    using Mesh = CGAL::Surface_mesh<Point>;
    Mesh mesh;
    std::vector<Mesh::Vertex_index> vertex;
    std::vector<Mesh::Vertex_index> moved;
    for (const Eigen::Vector3d& p : soup.points_mm) {
        vertex.push_back(mesh.add_vertex(Point(p.x(), p.y(), p.z())));
    }
    for (std::size_t v = 0; v < vertex.size(); ++v) {
        if (free[v] != 0) {
            moved.push_back(vertex[v]);
        }
    }
    for (const auto& [a, b, c] : soup.faces) {
        if (mesh.add_face(vertex[static_cast<std::size_t>(a)], vertex[static_cast<std::size_t>(b)],
                          vertex[static_cast<std::size_t>(c)]) == Mesh::null_face()) {
            return false;
        }
    }
    constexpr unsigned kTangents = 1;  // continuous
    if (!CGAL::Polygon_mesh_processing::fair(mesh, moved,
                                             CGAL::parameters::fairing_continuity(kTangents))) {
        return false;
    }
    for (const Mesh::Vertex_index v : moved) {
        const Point& p = mesh.point(v);
        if (!Eigen::Vector3d(p.x(), p.y(), p.z()).allFinite()) {
            return false;
        }
    }
    for (const Mesh::Vertex_index v : moved) {
        const Point& p = mesh.point(v);
        soup.points_mm[v.idx()] = {p.x(), p.y(), p.z()};
    }
    return true;
}

}  // namespace meshwind
