#include "geodesic/shortest_path.h"

#include <algorithm>
#include <array>
#include <iterator>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

#include "core/tolerances.h"

namespace meshwind {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Traits = CGAL::Surface_mesh_shortest_path_traits<Kernel, Mesh>;
using Tree = CGAL::Surface_mesh_shortest_path<Traits>;

// From a source on a rim CGAL finds ways that are too long (github.com/CGAL/cgal/issues/6681): one
// on an edge or vertex is moved inside its face by this barycentric share, 1e-6 of an edge.
constexpr double kSourceInset = 1e-6;

Mesh mesh_of(const Surface& surface) {
    Mesh mesh;
    const std::size_t faces = surface.face.size();
    mesh.reserve(static_cast<Mesh::size_type>(surface.position_mm.size()),
                 static_cast<Mesh::size_type>(3 * faces / 2), static_cast<Mesh::size_type>(faces));
    for (const Eigen::Vector3d& p : surface.position_mm) {
        mesh.add_vertex({p.x(), p.y(), p.z()});
    }
    for (const auto& corner : surface.face) {
        std::array<Mesh::Vertex_index, 3> v;
        std::transform(corner.begin(), corner.end(), v.begin(), [](std::int32_t i) {
            return Mesh::Vertex_index(static_cast<Mesh::size_type>(i));
        });
        mesh.add_face(v[0], v[1], v[2]);
    }
    return mesh;
}

}  // namespace

struct ShortestPaths::Impl {
    explicit Impl(const Surface& facets) : surface(facets), mesh(mesh_of(facets)), tree(mesh) {}

    // CGAL counts the corners of a face from the source of its first halfedge, and decides by exact
    // zeros whether a place is on an edge or a vertex: rounding there gives ways that are too long
    // (github.com/CGAL/cgal/issues/9646).
    [[nodiscard]] Tree::Face_location location(const SurfacePoint& point) const {
        const Mesh::Face_index face(static_cast<Mesh::size_type>(point.face));
        const auto first = static_cast<std::int32_t>(mesh.source(mesh.halfedge(face)).idx());
        const auto& corner = surface.face[static_cast<std::size_t>(point.face)];
        const auto shift = std::find(corner.begin(), corner.end(), first) - corner.begin();
        Eigen::Vector3d clean = (point.bary.array() < kBaryEps).select(0.0, point.bary);
        clean /= clean.sum();
        const auto bary = [&](std::ptrdiff_t i) { return clean[(shift + i) % 3]; };
        return {face, {bary(0), bary(1), bary(2)}};
    }

    const Surface& surface;
    Mesh mesh;
    Tree tree;
};

ShortestPaths::ShortestPaths(const Surface& surface, const SurfacePoint& source)
    : impl_(std::make_unique<Impl>(surface)) {
    SurfacePoint inside = source;
    inside.bary = source.bary.cwiseMax(kSourceInset);
    inside.bary /= inside.bary.sum();
    impl_->tree.add_source_point(impl_->location(inside));
    impl_->tree.build_sequence_tree();
}

ShortestPaths::~ShortestPaths() = default;
ShortestPaths::ShortestPaths(ShortestPaths&&) noexcept = default;
ShortestPaths& ShortestPaths::operator=(ShortestPaths&&) noexcept = default;

std::optional<PolyhedralPath> ShortestPaths::to(const SurfacePoint& target) {
    const Tree::Face_location place = impl_->location(target);
    std::vector<Kernel::Point_3> points;
    const auto found = impl_->tree.shortest_path_points_to_source_points(
        place.first, place.second, std::back_inserter(points));
    if (found.second == impl_->tree.source_points_end()) {
        return std::nullopt;
    }
    PolyhedralPath path;
    std::for_each(points.rbegin(), points.rend(), [&](const Kernel::Point_3& p) {
        path.points_mm.emplace_back(p.x(), p.y(), p.z());
    });
    for (std::size_t i = 1; i < path.points_mm.size(); ++i) {
        path.length_mm += (path.points_mm[i] - path.points_mm[i - 1]).norm();
    }
    return path;
}

}  // namespace meshwind
