/// Face adjacency across edges, in flat arrays, for meshes that are not yet manifold.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace meshwind {

/// One face's use of an undirected edge.
struct EdgeUse {
    std::int32_t low = 0;   ///< smaller vertex index
    std::int32_t high = 0;  ///< larger vertex index
    std::int32_t face = 0;
    std::int8_t edge = 0;       ///< edge of the face: from its corner `edge` to the next
    std::int8_t ascending = 0;  ///< 1 where the face runs from `low` to `high`
};

/// All uses, sorted by (low, high, face): the uses of one edge are consecutive.
/// \param faces index triples, three different vertices each
[[nodiscard]] std::vector<EdgeUse> edge_uses(std::span<const std::array<std::int32_t, 3>> faces);

/// Per face and edge the neighbouring face; -1 where the edge does not have exactly two uses.
[[nodiscard]] std::vector<std::array<std::int32_t, 3>> face_neighbours(
    std::span<const std::array<std::int32_t, 3>> faces);

/// Per face the number of its patch, a connected component across edges that are not parted;
/// numbered from 0 by their first face. \param parted whether patches end at an edge of a face;
/// asked from either side, with the same answer
[[nodiscard]] std::vector<std::int32_t> patches_of(
    const std::vector<std::array<std::int32_t, 3>>& neighbours,
    const std::function<bool(std::size_t face, std::size_t edge)>& parted);

/// Edge of `face` that it shares with `neighbour`, given the neighbours of `face`; -1 when none.
[[nodiscard]] int shared_edge(const std::array<std::int32_t, 3>& neighbours,
                              std::int32_t neighbour);

}  // namespace meshwind
