#include "mesh/edge_table.h"

#include <algorithm>
#include <tuple>

namespace meshwind {

std::vector<EdgeUse> edge_uses(std::span<const std::array<std::int32_t, 3>> faces) {
    std::vector<EdgeUse> uses;
    uses.reserve(3 * faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t from = faces[f][e];
            const std::int32_t to = faces[f][(e + 1) % 3];
            uses.push_back({std::min(from, to), std::max(from, to), static_cast<std::int32_t>(f),
                            static_cast<std::int8_t>(e), static_cast<std::int8_t>(from < to)});
        }
    }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return std::tie(a.low, a.high, a.face, a.edge) < std::tie(b.low, b.high, b.face, b.edge);
    });
    return uses;
}

std::vector<std::array<std::int32_t, 3>> face_neighbours(
    std::span<const std::array<std::int32_t, 3>> faces) {
    std::vector<std::array<std::int32_t, 3>> neighbours(faces.size(), {-1, -1, -1});
    const std::vector<EdgeUse> uses = edge_uses(faces);
    for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
        while (last < uses.size() && uses[last].low == uses[first].low &&
               uses[last].high == uses[first].high) {
            ++last;
        }
        if (last - first == 2) {
            const EdgeUse& a = uses[first];
            const EdgeUse& b = uses[first + 1];
            neighbours[static_cast<std::size_t>(a.face)][static_cast<std::size_t>(a.edge)] = b.face;
            neighbours[static_cast<std::size_t>(b.face)][static_cast<std::size_t>(b.edge)] = a.face;
        }
    }
    return neighbours;
}

int shared_edge(const std::array<std::int32_t, 3>& neighbours, std::int32_t neighbour) {
    for (int e = 0; e < 3; ++e) {
        if (neighbours[static_cast<std::size_t>(e)] == neighbour) {
            return e;
        }
    }
    return -1;
}

}  // namespace meshwind
