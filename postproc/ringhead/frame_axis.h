/// The axis of a frame, as a curve through the points of a table.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// Points this near to one another count as one: tables carry 1e-6 mm at best.
inline constexpr double kSamePoint_mm = 1e-5;

/// A point of the axis, mandrel frame.
struct AxisStation {
    Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ();    ///< unit, towards the next station
    Eigen::Vector3d reference = Eigen::Vector3d::UnitY();  ///< unit, at a right angle to it
    /// Turn of the frame as it passes, right-handed about the head's direction; unbounded.
    double turn_rad = 0.0;
};

/// The axis at one place. Mandrel frame, unit vectors at a right angle.
struct AxisFrame {
    Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d reference = Eigen::Vector3d::UnitY();  ///< to meet the head's reference
};

/// A curve through all stations with their tangents. Between two of them it is the cubic of
/// Hermite whose end speeds are chord / cos^2(turn of the tangent / 4): on an arc of circle that is
/// off by 2/27 sin^6(q) / cos^2(q) of the radius with q = turn / 4. The reference is carried along
/// without turning about the tangent (double reflection, wang_2008_rotation_minimizing) and turned
/// evenly by the angle then missing at the next station; the turn grows evenly. Accuracy: the arc
/// of 89 mm radius given every 10 mm is met within 1e-7 mm across and 5e-4 mm along the axis
/// (frame_axis_test.cpp).
class FrameAxis {
public:
    /// \pre two stations or more, neighbours apart, vectors as AxisStation says
    explicit FrameAxis(std::vector<AxisStation> stations);

    [[nodiscard]] const std::vector<AxisStation>& stations() const { return stations_; }
    /// Length of the axis from its start to each station, mm.
    [[nodiscard]] const std::vector<double>& station_s_mm() const { return s_mm_; }
    [[nodiscard]] double length_mm() const { return s_mm_.back(); }

    /// \param s_mm length from the start; held within 0 .. length_mm()
    [[nodiscard]] AxisFrame at(double s_mm) const;

private:
    std::vector<AxisStation> stations_;
    std::vector<double> s_mm_;
    std::vector<double> twist_rad_;  ///< per step, of the references against the carried one
};

/// Directions of the parabola through each point and its neighbours: of second order in their
/// distance, also where that varies. At the ends the outer parabola; the first and the last point
/// are neighbours when they are one (a closed frame). \pre neighbours are apart
[[nodiscard]] std::vector<Eigen::Vector3d> parabola_tangents(
    std::span<const Eigen::Vector3d> points_mm);

/// `reference` at the point `from_mm`, carried to `to_mm` without turning about the tangent (double
/// reflection, of fourth order in the distance). \pre unit vectors, the points are apart
[[nodiscard]] Eigen::Vector3d carried_reference(const Eigen::Vector3d& from_mm,
                                                const Eigen::Vector3d& from_tangent,
                                                const Eigen::Vector3d& to_mm,
                                                const Eigen::Vector3d& to_tangent,
                                                const Eigen::Vector3d& reference);

/// Reads a table with the columns `x_mm,y_mm,z_mm` and perhaps `tx,ty,tz` (the direction of the
/// axis, else parabola_tangents), `rx,ry,rz` (the reference, else the coordinate axis that is
/// furthest from the first tangent, carried along without turning) and `turn_deg` (added turn, else
/// 0). \param file name used in messages \throws InputError axis.column, axis.number, axis.too_few,
/// axis.same_point, axis.tangent, axis.reference, each with file and line
[[nodiscard]] FrameAxis read_axis_csv(std::string_view text, const std::string& file);

}  // namespace meshwind
