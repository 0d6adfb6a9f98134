/// Fits nodes to the curved stretches of a profile given by scattered points.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "mesh/revolution/meridian.h"
#include "mesh/revolution/profile_lines.h"

namespace meshwind {

/// A polynomial of the distance along a line, fitted to points near a place.
struct ProfilePolynomial {
    ProfileLine line;             ///< its origin is x = 0
    std::array<double, 5> off{};  ///< of the powers of x: distance from the line
    double reach_mm = 0.0;        ///< of the points that were used

    [[nodiscard]] double off_mm(double x) const;
    [[nodiscard]] double slope(double x) const;  ///< d off / d x
    [[nodiscard]] double bend_per_mm(double x) const;
    [[nodiscard]] Eigen::Vector2d at_mm(double x) const;
    [[nodiscard]] double slope_rad(double x) const;  ///< of the meridian's tangent
};

/// Weighted least squares about the points near `arc_mm`; x = 0 is their mean.
/// \param points ascending arc, two or more
[[nodiscard]] ProfilePolynomial polynomial_near(std::span<const ProfilePoint> points,
                                                double arc_mm);

/// How a curved stretch ends.
struct CurveEnd {
    enum class Kind {
        Point,  ///< at a rim or a crease
        Pole,   ///< on the axis, square to it
        Line    ///< goes on as a straight piece
    };
    Kind kind = Kind::Point;
    Eigen::Vector2d at_mm = Eigen::Vector2d::Zero();  ///< of Point and Pole; of a pole z nearly
    ProfileLine line;                                 ///< of Line
};

/// The nodes with those at both ends. An end at a line lies on it, is a crease where curve and line
/// meet at an angle, and else has no slope of its own.
/// \param points of the stretch, ascending arc \param places of the same points, two or more
[[nodiscard]] std::vector<MeridianNode> curve_nodes(std::span<const ProfilePoint> points,
                                                    std::span<const ProfilePlace> places,
                                                    const std::array<CurveEnd, 2>& end,
                                                    double tolerance_mm);

}  // namespace meshwind
