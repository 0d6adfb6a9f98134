#include "mesh/even/labelled_mesh.h"

#include <cmath>

#include "core/units.h"
#include "mesh/repair/repair.h"

namespace meshwind {

LabelledMesh wall_of(const LabelledView& part, const std::vector<char>& kept) {
    const auto is_wall = [&](std::int32_t face) {
        return face >= 0 &&
               kept[static_cast<std::size_t>(part.region[static_cast<std::size_t>(face)])] != 0;
    };
    LabelledMesh wall;
    std::vector<std::int32_t> renumbered(part.soup.points_mm.size(), -1);
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        if (!is_wall(static_cast<std::int32_t>(f))) {
            continue;
        }
        std::array<std::int32_t, 3> face = part.soup.faces[f];
        for (std::int32_t& v : face) {
            std::int32_t& target = renumbered[static_cast<std::size_t>(v)];
            if (target < 0) {
                target = static_cast<std::int32_t>(wall.soup.points_mm.size());
                wall.soup.points_mm.push_back(part.soup.points_mm[static_cast<std::size_t>(v)]);
            }
            v = target;
        }
        std::array<std::uint8_t, 3> feature = part.feature[f];
        for (std::size_t e = 0; e < 3; ++e) {
            feature[e] = is_wall(part.neighbours[f][e]) ? feature[e] : std::uint8_t{0};
        }
        wall.soup.faces.push_back(face);
        wall.feature.push_back(feature);
        wall.region.push_back(part.region[f]);
    }
    split_vertex_fans(wall.soup);
    return wall;
}

double size_mm(const LabelledMesh& part, const std::vector<char>& kept) {
    double area = 0.0;
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        if (kept[static_cast<std::size_t>(part.region[f])] != 0) {
            area += area_mm2(part.soup.points_mm, part.soup.faces[f]);
        }
    }
    return std::sqrt(area / (4.0 * kPi));
}

}  // namespace meshwind
