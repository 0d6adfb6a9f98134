/// Least-squares fits of cylinders, cones of revolution and balls to points.
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

namespace meshwind {

struct RuledShape {
    Eigen::Vector3d origin_mm = Eigen::Vector3d::Zero();  ///< on the axis
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();      ///< unit
    double radius_mm = 0.0;                               ///< at the origin
    double growth = 0.0;       ///< of the radius along the axis, no unit; 0: cylinder
    double residual_mm = 0.0;  ///< largest distance of a point, square to the surface

    /// The point of the surface nearest to `p`. \pre p is not on the axis
    [[nodiscard]] Eigen::Vector3d nearest(const Eigen::Vector3d& p) const;
    /// Distance of a point near the surface from it, >= 0.
    [[nodiscard]] double distance_mm(const Eigen::Vector3d& p) const;
    /// Unit normal away from the axis, on the ruling past `p`.
    /// \pre p is not on the axis
    [[nodiscard]] Eigen::Vector3d normal_at(const Eigen::Vector3d& p) const;
    /// Unit vector along that ruling. \pre p is not on the axis
    [[nodiscard]] Eigen::Vector3d ruling_at(const Eigen::Vector3d& p) const;
};

/// A facet between the points.
struct RuledFacet {
    Eigen::Vector3d centre_mm;
    Eigen::Vector3d normal;  ///< unit
    double area_mm2 = 0.0;
};

/// Least squares of the distances (Gauss and Newton), begun from the facets: their normals lie on a
/// cone about the axis and meet it. None where the facets turn too little to determine an axis.
[[nodiscard]] std::optional<RuledShape> fit_ruled_shape(std::span<const Eigen::Vector3d> points_mm,
                                                        std::span<const RuledFacet> facets);

/// \pre not empty
[[nodiscard]] Eigen::Vector3d mean_mm(std::span<const Eigen::Vector3d> points_mm);

struct BallShape {
    Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
    double radius_mm = 0.0;
};

/// Least squares of |p - c|^2 = r^2. None where the points determine no ball.
[[nodiscard]] std::optional<BallShape> fit_ball(std::span<const Eigen::Vector3d> points_mm);

}  // namespace meshwind
