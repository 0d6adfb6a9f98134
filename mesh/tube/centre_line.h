/// Centre lines of tubes: circular arcs and straight stretches with common tangents, and a frame
/// carried along them without twist.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// A stretch of constant curvature. Curvature counts in the carried frame: its part along
/// `reference` and its part along tangent x reference; both zero is straight, and as long as they
/// stay the same the stretch is a circular arc in a plane.
struct CentreArc {
    double length_mm = 0.0;  ///< >= 0
    Eigen::Vector2d curvature_per_mm = Eigen::Vector2d::Zero();
};

/// A place on the line.
struct CentrePlace {
    double arc_mm = 0.0;  ///< along the line
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ();    ///< unit, towards growing arc
    Eigen::Vector3d reference = Eigen::Vector3d::UnitX();  ///< unit, square to the tangent
    /// Towards the centre of curvature, 1 / bend radius long; zero where the line is straight.
    Eigen::Vector3d curvature_per_mm = Eigen::Vector3d::Zero();

    /// tangent x reference
    [[nodiscard]] Eigen::Vector3d across() const;
};

/// The frame turns with the tangent and no more (a Bishop frame), so an angle about the tangent
/// from `reference` keeps its direction all along, and on bends in one plane it never leaves that
/// plane. Before its start and beyond its end the line goes on straight.
class CentreLine {
public:
    /// \param start its arc and curvature are not read; tangent and reference unit and square to
    /// each other \pre arcs is not empty
    CentreLine(const CentrePlace& start, std::vector<CentreArc> arcs);

    [[nodiscard]] double length_mm() const { return nodes_.back().arc_mm; }
    [[nodiscard]] std::span<const CentreArc> arcs() const { return arcs_; }

    /// Joints of the arcs, with both ends: n + 1 for n arcs. Curvature is that of the arc that
    /// begins there, at the end that of the last one.
    [[nodiscard]] std::span<const CentrePlace> nodes() const { return nodes_; }

    /// \param arc_mm any; exact to rounding
    [[nodiscard]] CentrePlace at(double arc_mm) const;

    /// The nearest place; exact to rounding. It lies beyond an end only where no other node is
    /// nearer, lest an end that points back at the line be taken for it. \pre nearer to the line
    /// than its centres of curvature
    [[nodiscard]] CentrePlace foot(const Eigen::Vector3d& point_mm) const;

private:
    [[nodiscard]] CentrePlace along(std::size_t arc, double way_mm) const;
    [[nodiscard]] double way_under(std::size_t arc, const Eigen::Vector3d& point_mm) const;

    std::vector<CentreArc> arcs_;
    std::vector<CentrePlace> nodes_;
};

/// A line through points in order, two arcs from each to the next (a biarc); its tangent at a point
/// is that of the circle through the point and its neighbours. \param points_mm n >= 3, apart
[[nodiscard]] CentreLine line_through(std::span<const Eigen::Vector3d> points_mm);

}  // namespace meshwind
