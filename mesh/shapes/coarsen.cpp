#include "mesh/shapes/coarsen.h"

#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModAspectRatioT.hh>
#include <OpenMesh/Tools/Decimater/ModEdgeLengthT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalDeviationT.hh>

#include "core/units.h"
#include "mesh/edge_table.h"
#include "mesh/repair/open_mesh.h"
#include "mesh/segment/feature_edges.h"

namespace meshwind {
namespace {

// Longest edge that is collapsed, in edges aimed at.
constexpr double kLongestCollapse = 1.5;

// Area of a triangle of uneven edges, in squares of its mean edge; sqrt(3) / 4 = 0.433 were they
// equal.
constexpr double kTriangleShare = 0.38;

// Longest side over height that a collapse may leave where the triangle was better before.
constexpr float kWorstAspect = 5.0F;

void mark_creases(OpenTriMesh& mesh, const TriangleSoup& soup) {
    const auto neighbours = face_neighbours(soup.faces);
    const auto feature = feature_edges(soup, steady_normals(soup, neighbours), neighbours);
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (feature[f][e] == 0) {
                continue;
            }
            const OpenMesh::VertexHandle from(soup.faces[f][e]);
            const OpenMesh::VertexHandle to(soup.faces[f][(e + 1) % 3]);
            mesh.status(mesh.edge_handle(mesh.find_halfedge(from, to))).set_feature(true);
            mesh.status(from).set_feature(true);
            mesh.status(to).set_feature(true);
        }
    }
}

}  // namespace

TriangleSoup coarsened(const TriangleSoup& soup, double edge_mm) {
    OpenTriMesh mesh = open_mesh_of(soup);
    mark_creases(mesh, soup);
    mesh.request_face_normals();
    mesh.update_face_normals();
    using Decimater = OpenMesh::Decimater::DecimaterT<OpenTriMesh>;
    Decimater decimater(mesh);
    OpenMesh::Decimater::ModEdgeLengthT<OpenTriMesh>::Handle length;
    OpenMesh::Decimater::ModNormalDeviationT<OpenTriMesh>::Handle deviation;
    OpenMesh::Decimater::ModAspectRatioT<OpenTriMesh>::Handle aspect;
    decimater.add(length);
    decimater.add(deviation);
    decimater.add(aspect);
    decimater.module(length).set_binary(false);
    decimater.module(length).set_edge_length(static_cast<float>(kLongestCollapse * edge_mm));
    decimater.module(deviation).set_normal_deviation(
        static_cast<float>(deg_from_rad(kFeatureAngleRad)));
    decimater.module(aspect).set_aspect_ratio(kWorstAspect);
    decimater.initialize();
    const double faces = area_mm2(soup) / (kTriangleShare * edge_mm * edge_mm);
    if (faces < static_cast<double>(soup.faces.size())) {
        decimater.decimate_to_faces(0, static_cast<std::size_t>(faces));
    }
    return soup_of(mesh);
}

}  // namespace meshwind
