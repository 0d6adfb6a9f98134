/// Equal pipes whose axes lie in one plane and meet in one point, joined by a rolling-ball blend:
/// the geometry of wyes and crosses.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "mesh/shapes/analytic.h"
#include "mesh/shapes/make_walls.h"
#include "mesh/shapes/shapes.h"

namespace meshwind {

/// A pipe from the point where the axes meet. Its axis lies in the plane of x and z.
struct StarPipe {
    double azimuth_rad = 0.0;  ///< of its axis, from +z towards +x
    double length_mm = 0.0;    ///< from the meeting point to its rim
};

/// A ball of radius `blend_radius_mm` rolls along each crotch and touches the two pipes beside it.
/// Where all crotches meet, above and below the plane, the pipes are tangent to each other and the
/// blend vanishes.
struct PipeStar {
    double pipe_radius_mm = 0.0;
    double blend_radius_mm = 0.0;
    std::vector<StarPipe> pipes;  ///< by rising azimuth, within a turn; at most pi to the next

    /// From pipe k to the next, in (0, pi].
    [[nodiscard]] double angle_after(std::size_t k) const;
    /// Extent of the blends along pipe k, from the meeting point.
    [[nodiscard]] double blend_end_mm(std::size_t k) const;
};

/// Wye: the stem along -z, the arms at either side of +z. Cross: the run along z, the branches
/// along +x and -x. \pre the shape is valid
[[nodiscard]] PipeStar star_of(const WyeShape& shape);
[[nodiscard]] PipeStar star_of(const CrossShape& shape);

/// See tee_foot; the first pipe is the run, others are branches.
[[nodiscard]] ShapeFoot star_foot(const PipeStar& star, const Eigen::Vector3d& point_mm);

/// See make_wye.
[[nodiscard]] MadeWall wall_of(const PipeStar& star, double edge_mm);

}  // namespace meshwind
