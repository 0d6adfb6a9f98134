/// Material axes: the direction on each triangle from which fibre angles count.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "mesh/mandrel.h"

namespace meshwind {

/// Per triangle of the winding surface a unit vector in its plane, mandrel frame: the axis of the
/// part of the wall that it belongs to, projected on it.
///
/// On bodies of revolution that is the spindle axis, on tubes the tangent of the centre line. On
/// other surfaces it is the axial direction of the pipe (axial_direction_rad()), taken from the
/// nearest rim's or the spindle's axis where it is theirs, and where the wall is not like a pipe
/// the spindle axis. Where the spindle stands on the triangle it is the mandrel's X.
///
/// The spindle points to +Z. Over a pipe, however it bends, the axis keeps its sense, and on the
/// whole it points to +Z; where it lies square to that, to +X, and square to both to +Y.
[[nodiscard]] std::vector<Eigen::Vector3d> material_axes(const Mandrel& mandrel);

/// Angle of a direction on a triangle from its axis, -pi/2 < angle <= pi/2: fibres have no sense.
/// Positive is counter-clockwise seen from outside. \param axis, normal unit and square to each
/// other \param along not along the normal
[[nodiscard]] double ply_angle_rad(const Eigen::Vector3d& axis, const Eigen::Vector3d& normal,
                                   const Eigen::Vector3d& along);

}  // namespace meshwind
