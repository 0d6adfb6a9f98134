/// Pipes whose wall is cut along a curve where other pipes meet them: unrolled, filled and
/// triangulated. Tees, wyes and crosses consist of them and of blends.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "mesh/shapes/make_parts.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// A cylinder unrolled to (arc, axial), mm, with the closed curve along which its wall is cut and
/// the lattice on the side of it that is meshed.
struct PipeSheet {
    double period_mm = 0.0;
    std::vector<Eigen::Vector2d> flat;  ///< the curve, then the lattice; arc within one period
    std::vector<std::int32_t> ids;      ///< of the points in the soup
    std::int32_t contact_count = 0;     ///< the curve closes over the period or within it
    std::vector<std::vector<std::int32_t>> by_arc;  ///< segments of the curve, by stripes of arc
};

/// `value` shifted by whole periods into [0, period).
[[nodiscard]] double into_period(double value, double period);

/// Triangles between two rows of equally many points, seen from outside the second left of the
/// first; the diagonal is the shorter one each time. Points of one row may be the other's.
/// \param closed whether the last points are followed by the first
void join_rows(TriangleSoup& soup, const VertexRow& right, const VertexRow& left, bool closed);

struct SheetPiece {
    double from_mm;     ///< axial, a rim or below the piece
    double to_mm;       ///< axial, a rim
    bool piece_across;  ///< meshed side of the curve: that above it, or outside
    std::function<Eigen::Vector3d(const Eigen::Vector2d&)> roll;  ///< from the sheet into space
};

/// Fills the piece with rows of a triangular lattice, the last and for `from_mm` at a rim the first
/// exactly on the rims, and triangulates it. \pre the sheet has the curve alone
void mesh_piece(TriangleSoup& soup, PipeSheet& sheet, const SheetPiece& piece, double edge_mm);

}  // namespace meshwind
