/// Visibility of the outside from points of a surface, by ray casting.
#pragma once

#include "mesh/ray_query.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// Casts rays in a fixed set of directions, so results are reproducible. Thread-safe.
class Visibility {
public:
    /// \pre soup has faces
    explicit Visibility(const TriangleSoup& soup);

    /// Share (0 to 1) of the directions above `point`, weighted with their cosine to `normal`, in
    /// which a ray leaves the part without hitting it.
    /// \param point on the surface \param normal unit, the side to look from
    [[nodiscard]] double escape_fraction(const Eigen::Vector3d& point,
                                         const Eigen::Vector3d& normal) const;

    /// escape_fraction(point, normal) > share, without the rays that cannot change the answer.
    [[nodiscard]] bool escapes(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                               double share) const;

private:
    [[nodiscard]] int escaped(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                              int enough) const;
    RayQuery rays_;
    double diagonal_mm_;
};

}  // namespace meshwind
