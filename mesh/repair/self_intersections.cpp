#include "mesh/repair/self_intersections.h"

#include <iterator>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include "core/interrupt.h"

namespace meshwind {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

// The points of a mesh. Reading one is a cancellation point: CGAL offers no other.
struct WatchedPoints {
    using key_type = Mesh::Vertex_index;
    using value_type = Point;
    using reference = const Point&;
    using category = boost::readable_property_map_tag;

    const Mesh* mesh;

    friend const Point& get(const WatchedPoints& points, Mesh::Vertex_index vertex) {
        check_interrupt();
        return points.mesh->point(vertex);
    }
};

}  // namespace

std::vector<std::int32_t> self_intersecting_faces(const TriangleSoup& soup) {
    using Face = Mesh::Face_index;
    Mesh mesh;
    mesh.reserve(static_cast<Mesh::size_type>(soup.points_mm.size()),
                 static_cast<Mesh::size_type>(2 * soup.faces.size()),
                 static_cast<Mesh::size_type>(soup.faces.size()));
    for (const Eigen::Vector3d& p : soup.points_mm) {
        mesh.add_vertex(Point(p.x(), p.y(), p.z()));
    }
    for (const auto& face : soup.faces) {
        const auto vertex = [&](std::size_t i) {
            return Mesh::Vertex_index(static_cast<Mesh::size_type>(face[i]));
        };
        mesh.add_face(vertex(0), vertex(1), vertex(2));
    }
    std::vector<std::pair<Face, Face>> pairs;
    CGAL::Polygon_mesh_processing::self_intersections(
        mesh, std::back_inserter(pairs), CGAL::parameters::vertex_point_map(WatchedPoints{&mesh}));
    std::vector<char> crossed(soup.faces.size(), 0);
    for (const auto& [a, b] : pairs) {
        crossed[a] = 1;
        crossed[b] = 1;
    }
    std::vector<std::int32_t> faces;
    for (std::size_t f = 0; f < crossed.size(); ++f) {
        if (crossed[f] != 0) {
            faces.push_back(static_cast<std::int32_t>(f));
        }
    }
    return faces;
}

}  // namespace meshwind
