#include "mesh/even/fair.h"

#include <cstddef>
#include <iterator>
#include <optional>

#define CGAL_EIGEN3_ENABLED
#define CGAL_NDEBUG  // fair() asserts at every vertex that all faces are triangles
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/fair.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

namespace meshwind {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Vertex = Mesh::Vertex_index;

constexpr unsigned kTangents = 1;  // continuous

Eigen::Vector3d at(const Mesh& mesh, Vertex v) {
    const Point& p = mesh.point(v);
    return {p.x(), p.y(), p.z()};
}

// None where the faces are no manifold. Vertices and faces are numbered as in the soup.
std::optional<Mesh> mesh_of(const TriangleSoup& soup) {
    Mesh mesh;
    std::vector<Vertex> vertex;
    for (const Eigen::Vector3d& p : soup.points_mm) {
        vertex.push_back(mesh.add_vertex(Point(p.x(), p.y(), p.z())));
    }
    for (const auto& [a, b, c] : soup.faces) {
        if (mesh.add_face(vertex[static_cast<std::size_t>(a)], vertex[static_cast<std::size_t>(b)],
                          vertex[static_cast<std::size_t>(c)]) == Mesh::null_face()) {
            return std::nullopt;
        }
    }
    return mesh;
}

}  // namespace

bool fair(TriangleSoup& soup, const std::vector<char>& free) {
    std::optional<Mesh> mesh = mesh_of(soup);
    if (!mesh) {
        return false;
    }
    std::vector<Vertex> moved;
    for (const Vertex v : mesh->vertices()) {
        if (free[v] != 0) {
            moved.push_back(v);
        }
    }
    if (!pmp::fair(*mesh, moved, CGAL::parameters::fairing_continuity(kTangents))) {
        return false;
    }
    for (const Vertex v : moved) {
        if (!at(*mesh, v).allFinite()) {
            return false;
        }
    }
    for (const Vertex v : moved) {
        soup.points_mm[v] = at(*mesh, v);
    }
    return true;
}

bool fill_hole(TriangleSoup& soup, std::int32_t edge_from, std::int32_t edge_to) {
    std::optional<Mesh> mesh = mesh_of(soup);
    if (!mesh) {
        return false;
    }
    const Mesh::Halfedge_index inner =
        mesh->halfedge(Vertex(static_cast<Mesh::size_type>(edge_from)),
                       Vertex(static_cast<Mesh::size_type>(edge_to)));
    if (inner == Mesh::null_halfedge() || !mesh->is_border(mesh->opposite(inner))) {
        return false;
    }
    std::vector<Mesh::Face_index> faces;
    std::vector<Vertex> vertices;
    const auto done = pmp::triangulate_refine_and_fair_hole(
        *mesh, mesh->opposite(inner), std::back_inserter(faces), std::back_inserter(vertices),
        CGAL::parameters::fairing_continuity(kTangents));
    if (!std::get<0>(done) || faces.empty()) {
        return false;
    }
    for (const Vertex v : vertices) {
        if (!at(*mesh, v).allFinite()) {
            return false;
        }
    }
    for (std::size_t v = soup.points_mm.size(); v < mesh->num_vertices(); ++v) {
        soup.points_mm.push_back(at(*mesh, Vertex(static_cast<Mesh::size_type>(v))));
    }
    for (const Mesh::Face_index f : faces) {
        std::array<std::int32_t, 3> face{};
        std::size_t c = 0;
        for (const Vertex v : mesh->vertices_around_face(mesh->halfedge(f))) {
            face[c++] = static_cast<std::int32_t>(v.idx());
        }
        soup.faces.push_back(face);
    }
    return true;
}

}  // namespace meshwind
