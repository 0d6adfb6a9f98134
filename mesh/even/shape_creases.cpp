#include "mesh/even/shape_creases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "core/index.h"
#include "mesh/edge_table.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Shapes that meet at less than this (3 degrees) are one surface to fibre and to curves through
// vertices.
constexpr double kCreaseRad = 0.05;

class CreaseMarker {
public:
    CreaseMarker(const WallShapes& shapes, const std::vector<char>& kept, LabelledMesh& part)
        : shapes_(shapes),
          kept_(kept),
          part_(part),
          neighbours_(face_neighbours(part.soup.faces)) {}

    int run() {
        std::vector<std::array<std::uint8_t, 3>> marked = part_.feature;
        int count = 0;
        for (std::size_t i = 0; i < marked.size(); ++i) {
            const auto f = static_cast<std::int32_t>(i);
            for (std::size_t e = 0; e < 3; ++e) {
                const std::int32_t g = beyond(f, e);
                if (g >= 0 && marked[i][e] == 0 && shapes_.of_face[i] >= 0 &&
                    shapes_.of_face[at(g)] >= 0 && shapes_.of_face[i] != shapes_.of_face[at(g)] &&
                    meets(f, e, g)) {
                    const int back = shared_edge(neighbours_[at(g)], f);
                    marked[i][e] = 1;
                    marked[at(g)][at(back)] = 1;
                    ++count;
                }
            }
        }
        part_.feature = std::move(marked);
        return count;
    }

private:
    [[nodiscard]] const Vector3d& point(std::int32_t face, std::size_t c) const {
        return part_.soup.points_mm[at(part_.soup.faces[at(face)][c % 3])];
    }
    [[nodiscard]] std::int32_t beyond(std::int32_t f, std::size_t e) const {
        const std::int32_t g = neighbours_[at(f)][e];
        const auto is_wall = [&](std::int32_t face) {
            return kept_[at(part_.region[at(face)])] != 0;
        };
        return g >= 0 && is_wall(f) && is_wall(g) && part_.feature[at(f)][e] == 0 ? g : -1;
    }
    [[nodiscard]] Vector3d shape_normal(std::int32_t f, std::size_t e) const {
        return shapes_.shapes[at(shapes_.of_face[at(f)])].normal_at(
            0.5 * (point(f, e) + point(f, e + 1)));
    }

    [[nodiscard]] bool meets(std::int32_t f, std::size_t e, std::int32_t g) const {
        const int back = shared_edge(neighbours_[at(g)], f);
        return shape_normal(f, e).cross(shape_normal(g, static_cast<std::size_t>(back))).norm() >
               std::sin(kCreaseRad);
    }

    const WallShapes& shapes_;
    const std::vector<char>& kept_;
    LabelledMesh& part_;
    std::vector<std::array<std::int32_t, 3>> neighbours_;
};

}  // namespace

int mark_shape_creases(const WallShapes& shapes, const std::vector<char>& kept,
                       LabelledMesh& part) {
    return CreaseMarker(shapes, kept, part).run();
}

}  // namespace meshwind
