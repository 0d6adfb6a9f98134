/// Smoothing spline on a wall, within a tolerance of scattered points.
#pragma once

#include <cstddef>
#include <span>

#include "geodesic/surface_path.h"
#include "mesh/ray_query.h"
#include "mesh/surface.h"

namespace meshwind {

/// Moves the stations of a path sideways over the wall until its geodesic curvature changes as
/// little along it as the points allow: among all curves that pass within the tolerance of each
/// given station's place, about the one with the least integral of (d kg / ds)^2. So a path of
/// constant slip ratio, such as a geodesic, stays unchanged, and points that scatter about one
/// become it. Both ends stay where they are. A smoothing spline: the weight of the points is the
/// one with which the furthest is just within the tolerance.
/// \param wall with its facets \param given stations that stand for points, ascending
/// \param tolerance_mm > 0 \param path in: stations some mm apart; positions, normals, tangents and
/// lengths are new, kg is left at 0
/// \return largest distance of a given place from the curve, mm
double smooth_course(const Surface& wall, const RayQuery& facets,
                     std::span<const std::size_t> given, double tolerance_mm, SurfacePath& path);

}  // namespace meshwind
