#include "mesh/edge_table.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace meshwind {

std::vector<EdgeUse> edge_uses(std::span<const std::array<std::int32_t, 3>> faces) {
    const auto low = [&](std::size_t f, std::size_t e) {
        return static_cast<std::size_t>(std::min(faces[f][e], faces[f][(e + 1) % 3]));
    };
    // By the lower vertex first, by counting; what is left to sort is a handful at each vertex.
    std::vector<std::size_t> end(1, 0);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            end.resize(std::max(end.size(), low(f, e) + 1), 0);
            ++end[low(f, e)];
        }
    }
    std::exclusive_scan(end.begin(), end.end(), end.begin(), std::size_t{0});
    std::vector<EdgeUse> uses(3 * faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t from = faces[f][e];
            const std::int32_t to = faces[f][(e + 1) % 3];
            uses[end[low(f, e)]++] = {std::min(from, to), std::max(from, to),
                                      static_cast<std::int32_t>(f), static_cast<std::int8_t>(e),
                                      static_cast<std::int8_t>(from < to)};
        }
    }
    for (std::size_t v = 0; v < end.size(); ++v) {
        const auto at = [&](std::size_t i) {
            return uses.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::sort(at(v == 0 ? 0 : end[v - 1]), at(end[v]), [](const EdgeUse& a, const EdgeUse& b) {
            return std::tie(a.high, a.face, a.edge) < std::tie(b.high, b.face, b.edge);
        });
    }
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

std::vector<std::int32_t> patches_of(
    const std::vector<std::array<std::int32_t, 3>>& neighbours,
    const std::function<bool(std::size_t face, std::size_t edge)>& parted) {
    std::vector<std::int32_t> patch(neighbours.size(), -1);
    std::vector<std::size_t> stack;
    std::int32_t count = 0;
    for (std::size_t seed = 0; seed < patch.size(); ++seed) {
        if (patch[seed] >= 0) {
            continue;
        }
        patch[seed] = count;
        stack.push_back(seed);
        while (!stack.empty()) {
            const std::size_t f = stack.back();
            stack.pop_back();
            for (std::size_t e = 0; e < 3; ++e) {
                const std::int32_t g = neighbours[f][e];
                if (g >= 0 && patch[static_cast<std::size_t>(g)] < 0 && !parted(f, e)) {
                    patch[static_cast<std::size_t>(g)] = count;
                    stack.push_back(static_cast<std::size_t>(g));
                }
            }
        }
        ++count;
    }
    return patch;
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
