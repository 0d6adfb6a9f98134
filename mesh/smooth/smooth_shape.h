/// Evaluates the smooth surface that a frozen mesh approximates.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/units.h"
#include "mesh/surface.h"

namespace meshwind {

/// A line of rim or crease edges has a corner at a vertex where it turns by more than this.
inline constexpr double kLineCornerRad = rad_from_deg(34.0);

/// The curved patches of a surface, led to curves through the vertices of its rims.
class SmoothShape {
public:
    /// \pre `surface` outlives the shape
    explicit SmoothShape(const Surface& surface);

    /// Point on the patch of the face, moved within the surface to meet the arcs of the rim: by all
    /// of the gap on the rim, by none on the other edges.
    /// \param uv barycentric coordinates of the second and the third corner
    [[nodiscard]] Eigen::Vector3d point_at(std::int32_t face, const Eigen::Vector2d& uv) const;

    /// The parameters of corner i of a face.
    [[nodiscard]] static Eigen::Vector2d corner_uv(std::size_t i) {
        return {i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
    }

private:
    [[nodiscard]] Eigen::Vector3d rim_arc(std::int32_t from, std::int32_t to, double share) const;

    const Surface& surface_;
    /// Tangents of rims at their vertices, unit, in the direction of the rim's faces; a corner has
    /// none.
    std::vector<Eigen::Vector3d> rim_tangent_;
};

}  // namespace meshwind
