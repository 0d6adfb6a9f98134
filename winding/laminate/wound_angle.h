/// The winding angle of a course: between the fibre and the axial direction of the wall under it.
#pragma once

#include <optional>
#include <span>

#include "geodesic/surface_path.h"
#include "mesh/surface.h"
#include "winding/plan/figures.h"

namespace meshwind {

/// Angle between a path and the **axial direction** at a station, 0 (axial) to pi/2 (hoop). Axial
/// is the principal direction in which the wall is straighter; on every pipe that is the pipe's own
/// axis, on a run as on a branch. Nothing where the wall is not like a pipe: concave, or curved by
/// more than a quarter as much the other way, as on blends, knuckles and domes.
[[nodiscard]] std::optional<double> winding_angle_rad(const Surface& surface,
                                                      const PathPoint& station);

/// The axial direction at a place, as an angle from `smooth_normal().unitOrthogonal()`
/// counter-clockwise (as direction_angle() has it); nothing where the wall is not like a pipe.
[[nodiscard]] std::optional<double> axial_direction_rad(const Surface& surface,
                                                        const SurfacePoint& place);

/// Deviation of a course from a wanted winding angle.
struct AngleKept {
    double measured_mm = 0.0;  ///< length over pipes
    double off_mm = 0.0;       ///< of that, weighed by how far off: all of it from 10 degrees on
    double angle_mm = 0.0;     ///< integral of the angle over that length, mm rad
    double square_mm = 0.0;    ///< of the squared difference from the wish, mm rad^2
};
[[nodiscard]] AngleKept angle_kept(const Surface& surface, const SurfacePath& path,
                                   double wish_rad);

[[nodiscard]] WoundAngles wound_angles(const Surface& surface,
                                       std::span<const SurfacePath* const> courses,
                                       std::optional<double> wish_rad);

}  // namespace meshwind
