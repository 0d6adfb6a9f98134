/// The room that head and part take, known before anything is planned.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "machines/machine.h"
#include "mesh/triangle_soup.h"
#include "postproc/collision/collision.h"

namespace meshwind {

/// From the eye to the nearest part of the head; where the eye is within a part, less the radius of
/// the ball about it that this part fills.
[[nodiscard]] double head_gap_mm(const Machine& machine, const HeadEnvelope& envelope);

/// Free fibre with which the eye is so far off a cylinder. The fibre leaves along its tangent, so
/// with L mm of it at the winding angle a the eye is sqrt(R^2 + (L sin a)^2) from the axis.
/// \param off_mm >= 0 \param sine of the winding angle, > 0
[[nodiscard]] double free_length_over_cylinder_mm(double radius_mm, double off_mm, double sine);

/// The outline of a part that turns about Z: radius and z of the widest vertex of each of a
/// thousand slices. Each goes round a circle.
[[nodiscard]] std::vector<Eigen::Vector2d> outline(const TriangleSoup& part);

}  // namespace meshwind
