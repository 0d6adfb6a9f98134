/// Triangles labelled with their region, creases and shape.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Arrays per face are as long as `soup.faces`.
struct LabelledMesh {
    TriangleSoup soup;
    std::vector<std::int32_t> region;                  ///< per face
    std::vector<std::array<std::uint8_t, 3>> feature;  ///< per face and edge: 1 on a crease
    std::vector<std::int32_t> shape =
        {};  ///< per face: of wall_shapes.h, -1: none; empty: nothing is known
};

/// The same with its faces' neighbours, as segmentation holds it.
struct LabelledView {
    const TriangleSoup& soup;
    std::span<const std::int32_t> region;
    std::span<const std::array<std::uint8_t, 3>> feature;
    std::span<const std::array<std::int32_t, 3>> neighbours;  ///< see mesh/edge_table.h
};

/// The faces of the kept regions, in their order, one fan at each vertex; the edges where they end
/// are no creases. \param kept per region: whether it is wall
[[nodiscard]] LabelledMesh wall_of(const LabelledView& part, const std::vector<char>& kept);

/// The wall's size: radius of the ball with its area, mm. On a pipe four times as long as wide that
/// is 1.4 times its radius.
[[nodiscard]] double size_mm(const LabelledMesh& part, const std::vector<char>& kept);

}  // namespace meshwind
