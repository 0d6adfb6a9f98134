/// Meridians that sweep the shapes of revolution about z.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "mesh/shapes/analytic.h"
#include "mesh/shapes/shapes.h"

namespace meshwind {

/// A line, or an arc of an ellipse or of an isotensoid, in the plane (radius, z), from bottom to
/// top; outside is on its right.
struct ProfilePiece {
    ShapePart part = ShapePart::Cylinder;
    Eigen::Vector2d from_mm;       ///< of a line
    Eigen::Vector2d to_mm;         ///< of a line
    double centre_z_mm = 0.0;      ///< of an ellipse, whose centre is on the axis, or an equator
    Eigen::Vector2d semi_axes_mm;  ///< of an arc: radial, axial; zero for a line
    std::optional<IsotensoidDome> isotensoid;  ///< instead of the ellipse
    /// Eccentric angle of an ellipse, -pi/2 at its lower pole; the parameter of an isotensoid.
    double from_rad = 0.0;
    double to_rad = 0.0;
    bool sharp_end = false;  ///< the next piece goes on in another direction

    [[nodiscard]] bool is_line() const { return semi_axes_mm.x() == 0.0; }
    /// \param share of the way by arc length, 0 to 1
    [[nodiscard]] Eigen::Vector2d point_mm(double share) const;
    [[nodiscard]] double length_mm() const;
};

using Profile = std::vector<ProfilePiece>;

[[nodiscard]] Profile profile_of(const CylinderShape& shape);
[[nodiscard]] Profile profile_of(const ConeShape& shape);
[[nodiscard]] Profile profile_of(const VesselShape& shape);
[[nodiscard]] Profile profile_of(const IsotensoidShape& shape);
[[nodiscard]] Profile profile_of(const CombinationShape& shape);
[[nodiscard]] Profile profile_of(const EllipsoidShape& shape);

/// Nearest point of the surface of revolution; the profile's ends are extended as ShapeFoot says.
[[nodiscard]] ShapeFoot profile_foot(const Profile& profile, const Eigen::Vector3d& point_mm);

}  // namespace meshwind
