/// Pins that stand out of the mandrel's extension, and the taut fibre about one of them.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "mesh/mandrel.h"
#include "mesh/triangle_soup.h"
#include "winding/plan/turns.h"

namespace meshwind {

/// Constraints on the pins; 0 and none: chosen.
struct PinConstraints {
    int count = 0;  ///< >= 0: of a ring, a multiple of the circuits
    double diameter_mm = 2.0;
    std::optional<double> height_mm{};
    int skip = 0;  ///< >= 0: pins that a turn runs behind
    /// >= 0: least distance of the pins' axes from the rim; 0: a tow's width and a pin's diameter
    double offset_mm = 0.0;
};

/// One pin. Mandrel frame.
struct Pin {
    Eigen::Vector3d base_mm = Eigen::Vector3d::Zero();  ///< on the wall
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();    ///< unit, the wall's normal there
    double radius_mm = 1.0;                             ///< > 0, of the pin itself
    double height_mm = 5.0;                             ///< > 0, over its base
    /// >= 0: from the flank to the fibre's middle line. A tow that bears on a pin bunches to a
    /// strand.
    double strand_mm = 0.0;

    /// Distance of the fibre's middle line from the axis where it bears on the pin.
    [[nodiscard]] double held_mm() const { return radius_mm + strand_mm; }
};

/// Radius of the round strand with the cross-section of a tow: sqrt(width thickness / pi).
[[nodiscard]] double strand_radius_mm(double width_mm, double thickness_mm);

/// Axial length of the extension that the ring needs, and a band about its pins.
[[nodiscard]] double pin_extension_mm(const PinRing& ring, double band_mm);

[[nodiscard]] std::vector<Pin> pins_of(const PinRing& ring, const Rim& rim);

/// A pin as an obstacle: a closed cylinder from its base, sunk in by its own radius, to its top.
[[nodiscard]] TriangleSoup mesh_of(const Pin& pin);

/// Side of the fibre on which a pin lies, seen from outside in its direction of travel.
enum class PinSide { Right, Left };  ///< where the pin is

/// The taut fibre from a place to another about a pin's flank, without friction: straight, along a
/// helix at the distance held_mm() from the axis, and straight again, all at one slope to the pin.
struct PinString {
    double bend_rad = 0.0;  ///< about the axis, -pi .. pi; below zero it does not bear on the pin
    /// Unit: of the fibre where it begins.
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d out_mm = Eigen::Vector3d::Zero();  ///< where it leaves the flank
    double to_out_mm = 0.0;                            ///< length up to there
    double length_mm = 0.0;                            ///< of all of it
    double top_mm = 0.0;  ///< greatest height over the pin's base on the flank
    bool on_pin = false;  ///< it begins on the flank
};

/// Closed form: in the plane across the axis tangents to a circle, and the height is linear in the
/// length there. A place nearer to the axis than held_mm() counts as on the flank.
/// \pre neither place is on the axis
[[nodiscard]] PinString string_about(const Pin& pin, PinSide side, const Eigen::Vector3d& from_mm,
                                     const Eigen::Vector3d& to_mm);

/// The side on which a straight fibre touches a pin's flank below its top: none where it passes
/// beside or over it, or the pin is not ahead.
[[nodiscard]] std::optional<PinSide> side_touched(const Pin& pin, const Eigen::Vector3d& from_mm,
                                                  const Eigen::Vector3d& to_mm);

}  // namespace meshwind
