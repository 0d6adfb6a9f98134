/// OpenMesh in double precision, for topology edits. Included by .cpp files of this folder only.
#pragma once

#include "mesh/repair/open_mesh_kernel.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

struct OpenMeshTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge | OpenMesh::Attributes::Status);
};
using OpenTriMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMeshTraits>;

/// \pre soup is an oriented manifold; indices are kept
inline OpenTriMesh open_mesh_of(const TriangleSoup& soup) {
    OpenTriMesh mesh;
    mesh.reserve(soup.points_mm.size(), 2 * soup.faces.size(), soup.faces.size());
    for (const Eigen::Vector3d& p : soup.points_mm) {
        mesh.add_vertex({p.x(), p.y(), p.z()});
    }
    for (const auto& [a, b, c] : soup.faces) {
        mesh.add_face(OpenMesh::VertexHandle(a), OpenMesh::VertexHandle(b),
                      OpenMesh::VertexHandle(c));
    }
    return mesh;
}

/// Drops elements marked as deleted. \post vertices and faces in the mesh's order
inline TriangleSoup soup_of(OpenTriMesh& mesh) {
    mesh.garbage_collection();
    TriangleSoup soup;
    for (const auto v : mesh.vertices()) {
        const auto& p = mesh.point(v);
        soup.points_mm.emplace_back(p[0], p[1], p[2]);
    }
    for (const auto f : mesh.faces()) {
        auto corner = mesh.cfv_iter(f);
        std::array<std::int32_t, 3> face{};
        for (std::int32_t& v : face) {
            v = (corner++)->idx();
        }
        soup.faces.push_back(face);
    }
    return soup;
}

}  // namespace meshwind
