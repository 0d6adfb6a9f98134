/// The Jacobi field of a path: distance of neighbouring paths with another start angle.
#pragma once

#include <vector>

#include "geodesic/surface_path.h"
#include "mesh/surface.h"

namespace meshwind {

/// Gaussian curvature at a surface point from the shape operators interpolated between the
/// corners. Accuracy: second order in edge length (tests/geodesic/jacobi_field_test.cpp).
[[nodiscard]] double gaussian_curvature_per_mm2(const Surface& surface, const SurfacePoint& point);

/// The surface's curvature at a station, in the path's tangent t and binormal b. It bends
/// neighbouring paths apart or together.
struct CurvatureAlong {
    double gaussian_per_mm2 = 0.0;
    double normal_per_mm = 0.0;   ///< t . S t, kn of a convex path positive
    double across_per_mm = 0.0;   ///< b . S b
    double torsion_per_mm = 0.0;  ///< tau = b . S t of the surface along the path
};
[[nodiscard]] CurvatureAlong curvature_along(const Surface& surface, const PathPoint& station);

/// The distance j to the left, in mm per radian of start angle (counter-clockwise), at which a
/// neighbouring path of the same slip ratio passes each station; 0 at the start, and again at
/// **conjugate points**, where neighbouring paths meet. With kg = lambda kn and the torsion
/// tau = b . S t of the surface along the path,
///
///     j = y exp(lambda * integral of tau ds),   y'' + (1 + lambda^2) K y = 0,   y(0) = 0, y'(0) =
///     1
///
/// which is Jacobi's equation for lambda = 0; docs/geometry.md has the derivation. It leaves out
/// the bend of neighbours at a feature edge that is curved within the surface.
/// \param slip_ratio the same constant lambda that the path was steered with, concave places too
/// Accuracy: second order in edge length (tests/geodesic/jacobi_field_test.cpp).
[[nodiscard]] std::vector<double> jacobi_field_mm(const Surface& surface, const SurfacePath& path,
                                                  double slip_ratio);

}  // namespace meshwind
