#include "winding/revolution/mesh_projection.h"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

namespace meshwind {
namespace {

// Of the circle that turns as much from one station to the next.
double arc_between_mm(const PathPoint& a, const PathPoint& b) {
    const double chord = (b.position_mm - a.position_mm).norm();
    const double half =
        0.5 * std::atan2(a.tangent.cross(b.tangent).norm(), a.tangent.dot(b.tangent));
    return half > 0.0 ? chord * half / std::sin(half) : chord;
}

}  // namespace

MeshProjection::MeshProjection(const Surface& surface) : surface_(surface) {
    const auto point = [&](std::int32_t i) {
        return surface.position_mm[static_cast<std::size_t>(i)];
    };
    std::vector<Eigen::Vector3d> centres;
    for (const auto& [a, b, c] : surface.face) {
        centres.emplace_back((point(a) + point(b) + point(c)) / 3.0);
    }
    nearest_.emplace(centres);
}

void MeshProjection::move_under(const Eigen::Vector3d& place_mm,
                                std::optional<FieldWalker>& walker) const {
    if (!walker || !walker->move_under(place_mm)) {
        // On a rim the place may lie just beyond.
        walker.emplace(surface_, SurfacePoint{nearest_->nearest(place_mm)});
        (void)walker->move_under(place_mm);
    }
}

void MeshProjection::put(SurfacePath& path) const {
    std::optional<FieldWalker> walker;
    for (PathPoint& point : path) {
        move_under(point.position_mm, walker);
        point.at = walker->station(point.tangent).at;
    }
}

void MeshProjection::settle(
    SurfacePath& path,
    const std::function<Eigen::Vector3d(std::size_t i, const Eigen::Vector3d& position)>& direction)
    const {
    std::optional<FieldWalker> walker;
    for (std::size_t i = 0; i < path.size(); ++i) {
        move_under(path[i].position_mm, walker);
        path[i] = walker->station(direction(i, walker->position_mm()));
        if (i > 0) {
            path[i].s_mm = path[i - 1].s_mm + arc_between_mm(path[i - 1], path[i]);
        }
    }
}

}  // namespace meshwind
