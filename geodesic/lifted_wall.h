/// Facets lifted over the smooth wall, for a quick ray test that a straight fibre is clear of it.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "mesh/ray_query.h"
#include "mesh/surface.h"

namespace meshwind {

/// The facets of a surface, moved outward until none of its patches stands over them. One ray then
/// shows that a straight fibre is clear of the wall. Otherwise that takes a walk of many steps
/// along the fibre.
class LiftedWall {
public:
    /// \param surface outside = along its normals
    explicit LiftedWall(const Surface& surface);

    /// Upper bound of the facets' height over the wall, mm.
    [[nodiscard]] double height_mm() const { return height_mm_; }

    /// True where a straight fibre meets no wall: it begins higher over the wall than the facets
    /// and crosses none of them. False decides nothing.
    /// \pre `from` is outside
    [[nodiscard]] bool is_free(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

private:
    double height_mm_;
    std::optional<RayQuery> facets_;  // none where an edge is too sharp to be lifted
};

}  // namespace meshwind
