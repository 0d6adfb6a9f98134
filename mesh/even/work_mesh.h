/// Mesh data structure for remeshing: topology with labels of faces and edges.
/// Included by .cpp files of this folder only.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mesh/even/flip_angles.h"
#include "mesh/even/labelled_mesh.h"
#include "mesh/repair/open_mesh_kernel.h"

namespace meshwind {

inline constexpr std::int32_t kNoLine = -1;

/// An OpenMesh whose faces have a region, and whose edges may lie on a line: an edge where the wall
/// ends or a crease. Lines stay lines: local changes below never leave one or cross it. Faces that
/// are no wall change only where an edge of the wall's end is halved.
class WorkMesh {
public:
    struct Traits : OpenMesh::DefaultTraits {
        using Point = OpenMesh::Vec3d;
        using Normal = OpenMesh::Vec3d;
        VertexAttributes(OpenMesh::Attributes::Status);
        EdgeAttributes(OpenMesh::Attributes::Status);
        FaceAttributes(OpenMesh::Attributes::Status);
        HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge | OpenMesh::Attributes::Status);
    };
    using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
    using Vertex = Mesh::VertexHandle;
    using Edge = Mesh::EdgeHandle;
    using Face = Mesh::FaceHandle;
    using Halfedge = Mesh::HalfedgeHandle;

    /// Label of a face.
    struct FaceLabel {
        std::int32_t region = 0;
        std::int32_t shape = -1;  ///< index of the cylinder or cone it lies on, or -1
        bool wall = false;
    };
    /// Label of an edge.
    struct EdgeLabel {
        std::int32_t line = kNoLine;
        bool crease = false;
    };

    /// \param kept per region: whether it is wall \pre part is an oriented manifold
    WorkMesh(const LabelledMesh& part, const std::vector<char>& kept);

    Mesh mesh;

    [[nodiscard]] FaceLabel& label(Face face) { return mesh.property(face_label_, face); }
    [[nodiscard]] const FaceLabel& label(Face face) const {
        return mesh.property(face_label_, face);
    }
    [[nodiscard]] EdgeLabel& label(Edge edge) { return mesh.property(edge_label_, edge); }
    [[nodiscard]] const EdgeLabel& label(Edge edge) const {
        return mesh.property(edge_label_, edge);
    }

    [[nodiscard]] Eigen::Vector3d at(Vertex v) const {
        const auto& p = mesh.point(v);
        return {p[0], p[1], p[2]};
    }
    void move(Vertex v, const Eigen::Vector3d& p) { mesh.set_point(v, {p.x(), p.y(), p.z()}); }
    [[nodiscard]] double length(Edge edge) const { return mesh.calc_edge_length(edge); }
    [[nodiscard]] bool is_wall(Face face) const { return face.is_valid() && label(face).wall; }
    /// Whether at least one side is a face of the wall.
    [[nodiscard]] bool touches_wall(Edge edge) const;
    [[nodiscard]] bool is_line(Edge edge) const { return label(edge).line != kNoLine; }
    [[nodiscard]] int lines_at(Vertex v) const;
    /// A region of the wall at the vertex.
    [[nodiscard]] std::int32_t region_at(Vertex v) const;

    /// Halves an edge; both halves and all four triangles keep their labels.
    Vertex split(Edge edge, const Eigen::Vector3d& p);

    /// Whether the start of `half` may move to its end: lines stay, no triangle turns by more than
    /// the angle of `cosine`, no edge becomes longer than `longest_mm`.
    [[nodiscard]] bool may_collapse(Halfedge half, double cosine, double longest_mm);
    void collapse(Halfedge half);
    /// Largest distance of the start of `half` from the planes of the triangles that collapsing it
    /// leaves there.
    [[nodiscard]] double collapse_leaves_mm(Halfedge half) const;

    /// Whether the edge between two triangles of one region of the wall may be flipped without
    /// turning one of them by more than the angle of `cosine`.
    [[nodiscard]] bool may_flip(Edge edge, double cosine) const;
    /// Flips it. Triangles of different shapes have none afterwards.
    void flip(Edge edge);
    /// Cosine of the smallest angle of the two triangles, before and after.
    [[nodiscard]] FlipCosines angles(Edge edge) const;

    /// Whether a vertex may be moved without turning a triangle by more than the angle of `cosine`.
    [[nodiscard]] bool may_move(Vertex v, const Eigen::Vector3d& target, double cosine) const;

    /// Erases removed elements, and returns the part.
    [[nodiscard]] LabelledMesh part();

private:
    OpenMesh::FPropHandleT<FaceLabel> face_label_;
    OpenMesh::EPropHandleT<EdgeLabel> edge_label_;
};

}  // namespace meshwind
