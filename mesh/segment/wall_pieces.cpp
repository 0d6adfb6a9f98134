#include "mesh/segment/wall_pieces.h"

#include <algorithm>
#include <set>
#include <utility>

namespace meshwind {

std::vector<WallPiece> wall_pieces(const TriangleSoup& soup,
                                   const std::vector<std::array<std::int32_t, 3>>& neighbours,
                                   const std::vector<std::int32_t>& region) {
    std::vector<char> reached(neighbours.size(), 0);
    std::vector<WallPiece> pieces;
    for (std::size_t seed = 0; seed < neighbours.size(); ++seed) {
        if (reached[seed] != 0) {
            continue;
        }
        WallPiece piece;
        std::set<std::int32_t> regions;
        std::vector<std::size_t> stack{seed};
        reached[seed] = 1;
        while (!stack.empty()) {
            const std::size_t f = stack.back();
            stack.pop_back();
            const auto& [a, b, c] = soup.faces[f];
            const auto at = [&](std::int32_t v) {
                return soup.points_mm[static_cast<std::size_t>(v)];
            };
            const double area = area_mm2(soup.points_mm, soup.faces[f]);
            piece.area_mm2 += area;
            piece.middle_mm += area / 3.0 * (at(a) + at(b) + at(c));
            regions.insert(region[f]);
            for (const std::int32_t g : neighbours[f]) {
                if (g >= 0 && reached[static_cast<std::size_t>(g)] == 0) {
                    reached[static_cast<std::size_t>(g)] = 1;
                    stack.push_back(static_cast<std::size_t>(g));
                }
            }
        }
        if (piece.area_mm2 > 0.0) {
            piece.middle_mm /= piece.area_mm2;
        }
        piece.regions.assign(regions.begin(), regions.end());
        pieces.push_back(std::move(piece));
    }
    std::stable_sort(pieces.begin(), pieces.end(), [](const WallPiece& a, const WallPiece& b) {
        return a.area_mm2 > b.area_mm2;
    });
    return pieces;
}

}  // namespace meshwind
