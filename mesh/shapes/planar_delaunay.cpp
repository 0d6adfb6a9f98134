#include "mesh/shapes/planar_delaunay.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace meshwind {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
                                                            CGAL::No_constraint_intersection_tag>;

}  // namespace

std::vector<std::array<std::int32_t, 3>> planar_delaunay(
    std::span<const Eigen::Vector2d> points,
    std::span<const std::array<std::int32_t, 2>> constraints) {
    Delaunay delaunay;
    std::vector<Delaunay::Vertex_handle> handles;
    handles.reserve(points.size());
    Delaunay::Face_handle hint;
    for (const Eigen::Vector2d& point : points) {
        const auto handle = delaunay.insert(Kernel::Point_2(point.x(), point.y()), hint);
        handle->info() = static_cast<std::int32_t>(handles.size());
        hint = handle->face();
        handles.push_back(handle);
    }
    for (const auto& [a, b] : constraints) {
        delaunay.insert_constraint(handles[static_cast<std::size_t>(a)],
                                   handles[static_cast<std::size_t>(b)]);
    }
    std::vector<std::array<std::int32_t, 3>> triangles;
    triangles.reserve(delaunay.number_of_faces());
    for (const auto& face : delaunay.finite_face_handles()) {
        triangles.push_back(
            {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    return triangles;
}

}  // namespace meshwind
