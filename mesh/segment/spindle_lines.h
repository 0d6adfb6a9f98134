/// Possible spindle axes of a mandrel, and measures of a surface about a line.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/small_linear.h"
#include "core/units.h"
#include "mesh/rim.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

struct SpindleLine {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
    double residual_mm = 0.0;                              ///< of the rule that found it
};

/// A vertex with area-weighted normal: on a regular tessellation the noise of facets cancels.
struct WeighedPoint {
    Eigen::Vector3d point;
    Eigen::Vector3d normal;
    double area = 0.0;
};

[[nodiscard]] std::vector<WeighedPoint> weighed_points(const TriangleSoup& surface);
[[nodiscard]] Eigen::Vector3d centroid_of(const std::vector<WeighedPoint>& points);
[[nodiscard]] double distance_from(const SpindleLine& line, const Eigen::Vector3d& point);
[[nodiscard]] double mean_distance_from(const SpindleLine& line,
                                        const std::vector<WeighedPoint>& points);

/// RMS scatter of the surface's distance from the line.
[[nodiscard]] double scatter_about(const SpindleLine& line,
                                   const std::vector<WeighedPoint>& points);

/// Largest angle about the line in which there is no surface. Points close to the line, by a tenth
/// of `mean_radius_mm`, have no angle.
[[nodiscard]] double gap_about_rad(const SpindleLine& line, const std::vector<WeighedPoint>& points,
                                   double mean_radius_mm);

/// A wall goes all around its axis when it leaves no wider gap than this, a little more than a
/// prism of three sides does. A bend of a quarter or half a turn lies about the axis of its torus
/// as well, and nothing could hold it there.
inline constexpr double kWidestGap_rad = 0.7 * kPi;

/// Two rims that face away from each other on one line.
struct CoaxialRims {
    SpindleLine line;  ///< its origin is in the middle of the two centres
    double apart_mm = 0.0;
    std::size_t first = 0;  ///< indices
    std::size_t second = 0;
};

[[nodiscard]] std::vector<CoaxialRims> coaxial_rims(std::span<const Rim> rims);

/// Least-squares axis of the surface's normals, however good the fit; the residual is the rms
/// distance by which they miss it.
[[nodiscard]] SpindleLine line_of_normals(const std::vector<WeighedPoint>& points,
                                          const Eigen::Vector3d& centroid);

/// Axes of inertia of the surface through its centroid.
[[nodiscard]] PrincipalAxes<3> inertia_of(const std::vector<WeighedPoint>& points,
                                          const Eigen::Vector3d& centroid);

}  // namespace meshwind
