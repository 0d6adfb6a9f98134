#include "mesh/even/wall_pieces.h"

#include <algorithm>
#include <set>
#include <utility>

namespace meshwind {

std::vector<WallPiece> wall_pieces(const LabelledView& part, const std::vector<char>& kept) {
    const auto at = [](std::int32_t index) { return static_cast<std::size_t>(index); };
    const auto is_wall = [&](std::size_t f) { return kept[at(part.region[f])] != 0; };
    std::vector<char> reached(part.region.size(), 0);
    std::vector<WallPiece> pieces;
    for (std::size_t seed = 0; seed < reached.size(); ++seed) {
        if (reached[seed] != 0 || !is_wall(seed)) {
            continue;
        }
        WallPiece piece;
        std::set<std::int32_t> regions;
        std::vector<std::size_t> stack{seed};
        reached[seed] = 1;
        while (!stack.empty()) {
            const std::size_t f = stack.back();
            stack.pop_back();
            const auto& [a, b, c] = part.soup.faces[f];
            const std::vector<Eigen::Vector3d>& points = part.soup.points_mm;
            const double area = area_mm2(points, part.soup.faces[f]);
            piece.area_mm2 += area;
            piece.middle_mm += area / 3.0 * (points[at(a)] + points[at(b)] + points[at(c)]);
            regions.insert(part.region[f]);
            for (const std::int32_t g : part.neighbours[f]) {
                if (g >= 0 && reached[at(g)] == 0 && is_wall(at(g))) {
                    reached[at(g)] = 1;
                    stack.push_back(at(g));
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
