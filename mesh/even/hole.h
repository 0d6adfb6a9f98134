/// A part with some faces removed, and the hole left by removing more.
/// Included by .cpp files of this folder only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include <Eigen/Core>

#include "mesh/even/labelled_mesh.h"

namespace meshwind {

/// Faces of a part, some of them struck out. \pre the part outlives it
struct StruckPart {
    const TriangleSoup& soup;
    const std::vector<std::int32_t>& region;              ///< per face
    const std::vector<char>& kept;                        ///< per region: whether it is wall
    std::vector<std::array<std::int32_t, 3>> neighbours;  ///< see mesh/edge_table.h
    std::vector<std::vector<std::int32_t>> around;        ///< per point: its faces
    std::vector<char> struck;                             ///< per face
};

/// The part with no face struck out. \param kept per region: whether it is wall
[[nodiscard]] StruckPart unstruck(const LabelledMesh& part, const std::vector<char>& kept);

/// Unit normal of one face.
[[nodiscard]] Eigen::Vector3d face_normal(const TriangleSoup& soup,
                                          const std::array<std::int32_t, 3>& face);

/// An edge of a face that stays, next to one that goes.
struct BorderEdge {
    std::int32_t face = 0;  ///< that stays
    std::size_t from = 0;   ///< point where the edge begins in that face's order
    std::size_t to = 0;
};

/// The hole left by removed faces.
struct Hole {
    std::vector<BorderEdge> border;  ///< one loop
    std::int32_t region = 0;         ///< around it
};

/// The hole that `gone` leaves. None for more than one hole, or where the wall around it is not
/// one: in several regions, bounded by faces off the wall or struck out, or turning too much.
/// \param gone faces that go; some are added where the hole's outline touches itself
/// \param near_mm distance over which the wall around may hardly turn
[[nodiscard]] std::optional<Hole> hole_of(const StruckPart& part, std::set<std::int32_t>& gone,
                                          double near_mm);

}  // namespace meshwind
