/// A round tube about the axis of a frame, in closed form along the axis.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "postproc/ringhead/frame_axis.h"

namespace meshwind {

/// Foot point on a tube's axis: the place nearest to a point, and the point's direction from there.
struct TubeFoot {
    double s_mm = 0.0;         ///< along the axis; below 0 and above its length it goes on straight
    double distance_mm = 0.0;  ///< of the point from the axis
    double round_rad = 0.0;    ///< -pi .. pi, right-handed about the tangent from the reference
    Eigen::Vector3d normal = Eigen::Vector3d::UnitX();     ///< unit, from the axis to the point
    Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ();    ///< of the axis, unit
    Eigen::Vector3d surface_mm = Eigen::Vector3d::Zero();  ///< nearest point of the tube
};

/// The tube of one radius. Round angles count from the first station's reference, carried along
/// without turning about the tangent (the stations' own turn is left out), so that a straight
/// helix has d(round)/ds constant. Mandrel frame.
class TubeSurface {
public:
    /// \pre radius_mm > 0, and less than the axis' radius of curvature everywhere
    TubeSurface(const FrameAxis& axis, double radius_mm);

    [[nodiscard]] double radius_mm() const { return radius_mm_; }
    [[nodiscard]] double length_mm() const { return axis_.length_mm(); }

    /// The axis with its carried reference; straight beyond both ends.
    [[nodiscard]] AxisFrame axis_at(double s_mm) const;
    /// Curvature vector of the axis, per mm, towards the centre of the bend; zero beyond the ends.
    /// By central differences of the tangent over kCurvatureStep_mm; linear between such places.
    [[nodiscard]] Eigen::Vector3d axis_curvature(double s_mm) const;

    /// \param near_s_mm start of the search; the foot is found within 1e-9 mm of the axis when the
    /// point is nearer to it than the axis' radius of curvature there
    [[nodiscard]] TubeFoot foot(const Eigen::Vector3d& point_mm, double near_s_mm) const;
    [[nodiscard]] Eigen::Vector3d point(double s_mm, double round_rad) const;

    /// Curvature of the surface along a unit direction in its tangent plane, per mm, positive where
    /// it is convex: sin^2 a / r - cos^2 a k_in / (1 - r k_in) for the angle a from the axis and
    /// the share k_in of the axis' curvature towards the outward normal.
    [[nodiscard]] double normal_curvature(const TubeFoot& foot,
                                          const Eigen::Vector3d& direction) const;

    /// mm of the surface per mm of the axis at a place: 1 - r k_in; below 1 inside a bend.
    [[nodiscard]] double stretch(const TubeFoot& foot) const;

private:
    FrameAxis axis_;
    double radius_mm_;
    std::vector<Eigen::Vector3d> curvature_;  ///< every kCurvatureStep_mm
};

/// Where a bend begins the curvature of the axis jumps; it is seen spread over this length, a
/// fortieth of a tube's diameter of 20 mm.
inline constexpr double kCurvatureStep_mm = 0.5;

}  // namespace meshwind
