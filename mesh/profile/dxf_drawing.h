/// Reads lines and arcs of a DXF drawing. Included by .cpp files of this folder only.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// A line, or an arc about a centre by an angle, > 0 counter-clockwise. x along the axis, y the
/// radius, as drawn.
struct DrawnPiece {
    Eigen::Vector2d from;
    Eigen::Vector2d to;
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double sweep_rad = 0.0;  ///< 0: a line

    [[nodiscard]] bool is_line() const { return sweep_rad == 0.0; }
    /// \param share of the piece before the place
    [[nodiscard]] Eigen::Vector2d at(double share) const;
    /// Unit, towards `to`.
    [[nodiscard]] Eigen::Vector2d tangent(double share) const;
    [[nodiscard]] DrawnPiece reversed() const { return {to, from, centre, -sweep_rad}; }
};

struct DxfDrawing {
    std::vector<DrawnPiece> pieces;  ///< in file order
    double unit_mm = 0.0;            ///< 0: the drawing states none
};

/// Which entities are read, and which are passed over: see read_profile_dxf.
/// \param file name for the errors
/// \throws InputError profile.drawing, profile.points (more than 10,000 pieces), with the line
[[nodiscard]] DxfDrawing read_dxf(std::string_view text, const std::string& file);

}  // namespace meshwind
