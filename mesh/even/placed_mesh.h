/// A part's mesh during remeshing, with a constraint for each vertex: inside, on a line, fixed.
/// Included by .cpp files of this folder only.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/even/labelled_mesh.h"
#include "mesh/even/wall_surface.h"
#include "mesh/even/work_mesh.h"

namespace meshwind {

/// Where a vertex may go.
struct VertexPlace {
    enum class Kind { Inside, OnLine, Fixed };
    Kind kind = Kind::Fixed;
    std::int32_t line = kNoLine;
    std::int32_t corner = -1;  ///< number of a fixed place at the end of a line
    double way_mm = 0.0;       ///< along the line
    double size_mm = 0.0;      ///< wanted length of the edges here
};

/// A chain of edges that vertices slide along, from corner to corner.
struct CornerLine {
    WallLine curve;
    std::array<std::int32_t, 2> corner;  ///< at its ends, different ones
};

/// The triangles with a place for each vertex. Lines run between corners: vertices where they meet,
/// end or bend. A closed line with one corner or none gets corners.
class PlacedMesh {
public:
    /// Wanted lengths are 0. \param kept per region: whether it is wall
    /// \pre part is an oriented manifold
    PlacedMesh(const LabelledMesh& part, const std::vector<char>& kept);

    WorkMesh work;

    [[nodiscard]] VertexPlace& place(WorkMesh::Vertex v) { return work.mesh.property(place_, v); }
    [[nodiscard]] const VertexPlace& place(WorkMesh::Vertex v) const {
        return work.mesh.property(place_, v);
    }
    [[nodiscard]] const WallLine& curve(std::int32_t line) const;
    /// Positions of both ends of an edge along its line.
    [[nodiscard]] std::array<double, 2> ways_of(WorkMesh::Edge edge) const;

private:
    OpenMesh::VPropHandleT<VertexPlace> place_;
    std::vector<CornerLine> lines_;
};

}  // namespace meshwind
