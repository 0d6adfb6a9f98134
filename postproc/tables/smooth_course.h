/// A smooth curve on a wall within a tolerance of points that scatter.
#pragma once

#include <cstddef>
#include <span>

#include "geodesic/surface_path.h"
#include "mesh/ray_query.h"
#include "mesh/surface.h"

namespace meshwind {

/// Moves the stations of a path sideways over the wall until its geodesic curvature changes as
/// little along it as the points allow: of all curves that pass within the tolerance of each given
/// station's place, about that of the least integral of (d kg / ds)^2. So a path of a constant
/// slip ratio, a geodesic among them, stays what it is, and what scatters about one becomes it.
/// Both ends stay where they are. A smoothing spline: the weight of the points is the one with
/// which the furthest is just within the tolerance.
/// \param wall with its facets \param given stations that stand for points, ascending
/// \param tolerance_mm > 0 \param path in: stations some mm apart; positions, normals, tangents and
/// lengths are new, kg is left at 0
/// \return how far the furthest given place is from the curve, mm
double smooth_course(const Surface& wall, const RayQuery& facets,
                     std::span<const std::size_t> given, double tolerance_mm, SurfacePath& path);

}  // namespace meshwind
