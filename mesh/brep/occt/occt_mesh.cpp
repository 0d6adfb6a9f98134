#include "mesh/brep/occt/occt_mesh.h"

#include <array>
#include <cmath>

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// How far triangles are off the faces, as a share of the part, and by how much they turn along an
// edge.
constexpr double kDeflection = 1e-3;
constexpr double kTurn_rad = 0.15;

}  // namespace

void tessellate(const TopoDS_Shape& shape) {
    Bnd_Box box;
    BRepBndLib::Add(shape, box);
    IMeshTools_Parameters wanted;
    wanted.Deflection = kDeflection * std::sqrt(box.SquareExtent());
    wanted.Angle = kTurn_rad;
    wanted.MinSize = wanted.Deflection;  // else spline faces with many knots take minutes
    wanted.InParallel = Standard_False;
    const BRepMesh_IncrementalMesh mesher(shape, wanted);
}

FaceTriangles::FaceTriangles(const TopoDS_Face& face)
    : triangles(BRep_Tool::Triangulation(face, location)) {}

bool FaceTriangles::none() const {
    return triangles.IsNull() || triangles->NbTriangles() == 0;
}

Vector3d FaceTriangles::node_mm(int i) const {
    return vector_of(triangles->Node(i).Transformed(location.Transformation()));
}

std::vector<Vector3d> FaceTriangles::nodes_mm() const {
    std::vector<Vector3d> at_mm;
    for (int n = 1; n <= triangles->NbNodes(); ++n) {
        at_mm.push_back(node_mm(n));
    }
    return at_mm;
}

std::vector<Vector2d> FaceTriangles::uv() const {
    std::vector<Vector2d> found;
    for (int n = 1; triangles->HasUVNodes() && n <= triangles->NbNodes(); ++n) {
        const gp_Pnt2d place = triangles->UVNode(n);
        found.emplace_back(place.X(), place.Y());
    }
    return found;
}

SharedMesh::SharedMesh(const TopoDS_Shape& shape) {
    TopExp::MapShapes(shape, TopAbs_EDGE, edges_);
    TopExp::MapShapes(shape, TopAbs_VERTEX, vertices_);
    used_.assign(static_cast<std::size_t>(edges_.Extent()) + 1, 0);
}

void SharedMesh::add(const FaceTriangles& triangles, const TopoDS_Face& face, std::int32_t number) {
    const std::vector<std::int32_t> points = points_of(triangles, face, number);
    const bool reversed = face.Orientation() == TopAbs_REVERSED;
    const bool turned = reversed != triangles.location.Transformation().IsNegative();
    for (int t = 1; t <= triangles.triangles->NbTriangles(); ++t) {
        int a = 0, b = 0, c = 0;
        triangles.triangles->Triangle(t).Get(a, b, c);
        if (turned) {
            std::swap(b, c);
        }
        const std::array<std::int32_t, 3> corners = {points[static_cast<std::size_t>(a)],
                                                     points[static_cast<std::size_t>(b)],
                                                     points[static_cast<std::size_t>(c)]};
        if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) {
            mesh_.soup.faces.push_back(corners);
            mesh_.face.push_back(number);
        }
    }
}

OcctMesh SharedMesh::mesh() && {
    for (int i = 1; i <= edges_.Extent(); ++i) {
        const bool open = used_[static_cast<std::size_t>(i)] == 1 &&
                          !BRep_Tool::Degenerated(TopoDS::Edge(edges_(i)));
        mesh_.open_edges += open ? 1 : 0;
    }
    return std::move(mesh_);
}

// Of the face's nodes; what is on no edge is the face's own.
std::vector<std::int32_t> SharedMesh::points_of(const FaceTriangles& triangles,
                                                const TopoDS_Face& face, std::int32_t number) {
    const int nodes = triangles.triangles->NbNodes();
    std::vector<std::int32_t> points(static_cast<std::size_t>(nodes) + 1, -1);
    for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
        take_edge(triangles, TopoDS::Edge(at.Current()), number, points);
    }
    for (int n = 1; n <= nodes; ++n) {
        std::int32_t& own = points[static_cast<std::size_t>(n)];
        if (own < 0) {
            own = static_cast<std::int32_t>(mesh_.soup.points_mm.size());
            mesh_.soup.points_mm.push_back(triangles.node_mm(n));
        }
    }
    return points;
}

void SharedMesh::take_edge(const FaceTriangles& triangles, const TopoDS_Edge& edge,
                           std::int32_t number, std::vector<std::int32_t>& points) {
    const Handle(Poly_PolygonOnTriangulation) polygon =
        BRep_Tool::PolygonOnTriangulation(edge, triangles.triangles, triangles.location);
    if (polygon.IsNull()) {
        return;
    }
    const int id = edges_.FindIndex(edge);
    ++used_[static_cast<std::size_t>(id)];
    const bool point_only = BRep_Tool::Degenerated(edge);
    const TopoDS_Vertex first = TopExp::FirstVertex(edge);
    const TopoDS_Vertex last = TopExp::LastVertex(edge);
    for (int i = 1; i <= polygon->NbNodes(); ++i) {
        const int n = polygon->Node(i);
        const bool at_first = point_only || i == 1;
        Key key(id, i);
        if (at_first || i == polygon->NbNodes()) {
            const TopoDS_Vertex& vertex = at_first ? first : last;
            key = {0, vertices_.FindIndex(vertex)};
            shared_point(key, vector_of(BRep_Tool::Pnt(vertex)), number);
        }
        points[static_cast<std::size_t>(n)] = shared_point(key, triangles.node_mm(n), number);
    }
}

std::int32_t SharedMesh::shared_point(const Key& key, const Vector3d& p, std::int32_t number) {
    const auto [found, is_new] =
        shared_.try_emplace(key, static_cast<std::int32_t>(mesh_.soup.points_mm.size()));
    if (is_new) {
        mesh_.soup.points_mm.push_back(p);
        return found->second;
    }
    const double off = (mesh_.soup.points_mm[static_cast<std::size_t>(found->second)] - p).norm();
    if (off > mesh_.off_face_mm) {
        mesh_.off_face_mm = off;
        mesh_.off_face = number;
    }
    return found->second;
}

}  // namespace meshwind
