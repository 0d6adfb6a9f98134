/// Triangles of an Open CASCADE shape that share their points along its edges.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Poly_Triangulation.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Dir.hxx>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

#include "mesh/triangle_soup.h"

namespace meshwind {

[[nodiscard]] inline Eigen::Vector3d vector_of(const gp_XYZ& p) {
    return {p.X(), p.Y(), p.Z()};
}
[[nodiscard]] inline Eigen::Vector3d vector_of(const gp_Pnt& p) {
    return vector_of(p.XYZ());
}
[[nodiscard]] inline Eigen::Vector3d vector_of(const gp_Vec& v) {
    return vector_of(v.XYZ());
}
[[nodiscard]] inline Eigen::Vector3d vector_of(const gp_Dir& d) {
    return vector_of(d.XYZ());
}

/// Triangles between points of the exact edges and faces, as narrow as the faces allow.
struct OcctMesh {
    TriangleSoup soup;  ///< points shared by faces occur once
    std::vector<std::int32_t> face;
    double off_face_mm = 0.0;  ///< largest distance of a shared point from one of its faces
    std::int32_t off_face = -1;
    int open_edges = 0;
    std::vector<std::int32_t> failed_faces;
};

/// Tessellates the faces of a shape by Open CASCADE.
void tessellate(const TopoDS_Shape& shape);

/// The tessellation of a face. Nodes count from 1.
struct FaceTriangles {
    TopLoc_Location location;
    Handle(Poly_Triangulation) triangles;

    explicit FaceTriangles(const TopoDS_Face& face);

    [[nodiscard]] bool none() const;
    [[nodiscard]] Eigen::Vector3d node_mm(int i) const;
    [[nodiscard]] std::vector<Eigen::Vector3d> nodes_mm() const;  ///< from 0
    [[nodiscard]] std::vector<Eigen::Vector2d> uv() const;        ///< of the nodes; or empty
};

/// Gathers the triangles of a shape's faces; points shared by faces occur once.
class SharedMesh {
public:
    explicit SharedMesh(const TopoDS_Shape& shape);

    /// \param number of the face
    void add_failed(std::int32_t number) { mesh_.failed_faces.push_back(number); }
    void add(const FaceTriangles& triangles, const TopoDS_Face& face, std::int32_t number);

    [[nodiscard]] OcctMesh mesh() &&;

private:
    // Points of edges by the edge's number and theirs along it, points of vertices as those of no
    // edge.
    using Key = std::pair<int, int>;

    [[nodiscard]] std::vector<std::int32_t> points_of(const FaceTriangles& triangles,
                                                      const TopoDS_Face& face, std::int32_t number);
    void take_edge(const FaceTriangles& triangles, const TopoDS_Edge& edge, std::int32_t number,
                   std::vector<std::int32_t>& points);
    std::int32_t shared_point(const Key& key, const Eigen::Vector3d& p, std::int32_t number);

    OcctMesh mesh_;
    TopTools_IndexedMapOfShape edges_;
    TopTools_IndexedMapOfShape vertices_;
    std::map<Key, std::int32_t> shared_;
    std::vector<int> used_;  // by how many faces, per edge
};

}  // namespace meshwind
