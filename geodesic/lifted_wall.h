/// Facets over the smooth wall: what passes over them passes over the wall.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "mesh/ray_query.h"
#include "mesh/surface.h"

namespace meshwind {

/// The facets of a surface, moved outward until none of its patches stands over them. One ray then
/// tells that a straight fibre keeps off the wall, which takes a walk of many steps along it else.
class LiftedWall {
public:
    /// \param surface outside = along its normals
    explicit LiftedWall(const Surface& surface);

    /// Nothing of the facets is higher over the wall, mm.
    [[nodiscard]] double height_mm() const { return height_mm_; }

    /// True where a straight fibre meets no wall: it begins higher over it than the facets are, and
    /// passes none of them. False says nothing.
    /// \pre `from` is outside
    [[nodiscard]] bool is_free(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

private:
    double height_mm_;
    std::optional<RayQuery> facets_;  // none where an edge is too sharp to be lifted
};

}  // namespace meshwind
