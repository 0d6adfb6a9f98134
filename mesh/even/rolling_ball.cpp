#include "mesh/even/rolling_ball.h"

#include <span>

#include <Eigen/Geometry>

#include "core/parallel.h"
#include "mesh/ray_query.h"

namespace meshwind {
namespace {

// A ball touches a facet when nothing reaches deeper into it than this share of its radius; facets
// of a convex wall reach less.
constexpr double kReaches = 0.01;

}  // namespace

std::vector<char> out_of_reach(const TriangleSoup& wall, double radius_mm, WallSide side) {
    const RayQuery query{std::span(&wall, 1)};
    const double centre_mm = side == WallSide::Outside ? radius_mm : -radius_mm;
    std::vector<char> out(wall.faces.size(), 0);
    constexpr std::size_t kChunk = 256;
    parallel_for(out.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            const auto& [a, b, c] = wall.faces[f];
            const Eigen::Vector3d& pa = wall.points_mm[static_cast<std::size_t>(a)];
            const Eigen::Vector3d& pb = wall.points_mm[static_cast<std::size_t>(b)];
            const Eigen::Vector3d& pc = wall.points_mm[static_cast<std::size_t>(c)];
            const Eigen::Vector3d normal = (pb - pa).cross(pc - pa).normalized();
            const Eigen::Vector3d centre = (pa + pb + pc) / 3.0 + centre_mm * normal;
            out[f] = static_cast<char>(query.closest(centre, radius_mm).distance_mm <
                                       (1.0 - kReaches) * radius_mm);
        }
    });
    return out;
}

}  // namespace meshwind
