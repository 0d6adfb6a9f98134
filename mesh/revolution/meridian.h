/// Meridian of a body of revolution by arc length: the curve swept about the spindle axis.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace meshwind {

/// A point on a meridian, with the slope and breaks given there.
struct MeridianNode {
    double radius_mm = 0.0;
    double z_mm = 0.0;
    bool crease = false;  ///< the slope jumps here
    /// Slope of the tangent where a run of curved pieces starts or ends (at an end, a crease, a
    /// joint or beside a straight piece); not read elsewhere. At a crease, that of the piece behind
    /// it.
    std::optional<double> slope_rad{};
    std::optional<double> slope_before_rad{};  ///< at a crease, of the piece before it
    bool joint = false;                        ///< the slope goes on, the curvature may jump
    bool straight = false;                     ///< the piece to the next node is a straight line
};

/// A place of a meridian. The tangent towards growing arc length is (sin slope, cos slope) in
/// (radius, z).
struct MeridianPlace {
    double radius_mm = 0.0;
    double z_mm = 0.0;
    double slope_rad = 0.0;         ///< -pi to pi; 0 on a cylinder, pi/2 at a lower pole
    double curvature_per_mm = 0.0;  ///< -d slope / d arc: > 0 where convex seen from outside
};

/// Nearest point of a meridian to a point of the half plane (radius, z).
struct MeridianFoot {
    double arc_mm = 0.0;
    double distance_mm = 0.0;  ///< >= 0
};

/// One polynomial of a meridian: a cubic by its ends and the derivatives there, or a straight line.
struct MeridianPiece {
    Eigen::Vector2d from_mm, to_mm;      ///< (radius, z)
    Eigen::Vector2d tangent0, tangent1;  ///< by the parameter, which is about the arc length
    Eigen::Vector2d middle_mm;
    double reach_mm = 0.0;   ///< no point of it is farther from `middle_mm`
    double step_mm = 0.0;    ///< the parameter goes from 0 to here
    double length_mm = 0.0;  ///< arc length
    bool straight = false;
};

/// A plane curve in (radius, z) with outside on its right. Curved runs are cubic splines, twice
/// continuously differentiable, of radius and z over arc length; straight pieces are straight to
/// rounding. Immutable.
///
/// A piece is straight where its first node says so, where four or more nodes in a row, or all
/// between two breaks, lie on one line to rounding. Straight and curved pieces meet with one slope
/// and a jump in curvature; two straight pieces at an angle make a crease. Where no slope is given,
/// a run ends with the not-a-knot condition, except at a radius of 0, which is a smooth pole with
/// slope +-pi/2 unless the piece there is straight (the tip of a cone).
///
/// Accuracy: nodes h apart on an arc of radius R give slopes within h^3 / R^3 / 50 and, over an arc
/// of 1.5 R, places within h^4 / R^3 / 200, where the slopes at its ends are known; free ends lose
/// a factor of ten, not the order; tests/mesh/revolution/meridian_test.cpp. Source:
/// deboor_2001_splines, ch. IV.
class Meridian {
public:
    /// \throws InputError meridian.node: fewer than two, one not finite, one twice in a row, a
    /// radius below 0, or of 0 between the ends
    explicit Meridian(std::vector<MeridianNode> nodes);

    [[nodiscard]] double length_mm() const { return arc_mm_.back(); }

    /// Clamped to [0, length]; at a crease or joint the place behind it.
    [[nodiscard]] MeridianPlace at(double arc_mm) const;

    /// Arc lengths of the creases, ascending; the ends are not among them.
    [[nodiscard]] std::span<const double> creases_mm() const { return creases_mm_; }

    /// Arc lengths of all nodes, ascending from 0: between two of them the curve is smooth.
    [[nodiscard]] std::span<const double> nodes_mm() const { return arc_mm_; }

    /// Arc length of the first largest radius; on a cylinder, its middle. A cylinder that is as
    /// wide to rounding takes precedence.
    [[nodiscard]] double widest_mm() const;

    /// The nearest place; of several equally near, the first.
    [[nodiscard]] MeridianFoot foot(double radius_mm, double z_mm) const;

    /// The pieces between each node and the next.
    [[nodiscard]] std::span<const MeridianPiece> pieces() const { return pieces_; }

private:
    std::vector<MeridianPiece> pieces_;
    std::vector<double> arc_mm_;  // at the nodes
    std::vector<double> creases_mm_;
};

}  // namespace meshwind
