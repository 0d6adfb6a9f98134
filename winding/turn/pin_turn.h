/// Turns on pins. The fibre leaves over a rim at its winding angle and passes between two pins on
/// the extension. It bends about one, runs behind some along the hoop, bends about the last and
/// comes back.
///
/// On the unrolled cylinder the fibre consists of straight lines and arcs tangent to them: with R
/// the extension's radius, alpha the angle to the axis, z the pins' distance from the rim, rho that
/// of the fibre from a pin's axis, from the rim to the pin that is bent about
///
///     around = z tan(alpha) + rho / cos(alpha)
///     length = (z + rho sin(alpha)) / cos(alpha) + (pi / 2 - alpha) rho
///
/// and k p along the hoop, p from pin to pin and k pins run behind. In patterns alpha is the same
/// on the way back; courses come back at their own.
///
/// Pins that stand as closely as bands do are all touched by a free fibre that sinks towards the
/// wall behind them. So the last one takes hold of it ahead of the landing point: with psi from
/// there to the pin the fibre is R (1 / cos(psi) - 1) over the wall at the pin, below its top, and
/// higher than the top at the next. Only then the eye swings round, and while the landing point
/// comes up to the pin it goes down to the wall again. See docs/winding.md, "Turns on pins".
#pragma once

#include <optional>
#include <string>

#include "winding/plan/assemble.h"
#include "winding/plan/plan.h"
#include "winding/turn/pin.h"
#include "winding/turn/turn.h"

namespace meshwind {

/// A turn on the unrolled extension.
struct PinTurnShape {
    double radius_mm = 0.0;            ///< of the extension
    double angle_rad = 0.0;            ///< between fibre and axis at the rim, 0 < .. < pi / 2
    std::optional<double> back_rad{};  ///< the same on the way back, where it is another
    double held_mm = 0.0;              ///< rho
    double offset_mm = 0.0;            ///< z
    double pitch_mm = 0.0;             ///< p
    int skip = 0;                      ///< k
    double lead_mm = 0.0;      ///< of the landing point before the last pin as the eye swings
    double diameter_mm = 0.0;  ///< of the pins

    [[nodiscard]] double out_rad() const { return back_rad.value_or(angle_rad); }
};

/// Distance around the extension from a crossing of the rim to the pin that the fibre bends about.
[[nodiscard]] double to_pin_mm(const PinTurnShape& shape, double angle_rad);

/// Distance around the extension between the two crossings of the rim.
[[nodiscard]] double pin_turn_around_mm(const PinTurnShape& shape);

/// Length of the fibre between the two crossings of the rim.
[[nodiscard]] double pin_turn_length_mm(const PinTurnShape& shape);

/// Whether pins can take hold of the fibre one by one, and how.
struct PinFit {
    double height_mm = 0.0;  ///< of the pins
    double lead_mm = 0.0;
    int least_skip = 0;    ///< so that the landing point has left the first pin when the last one
                           ///< takes hold
    double room_mm = 0.0;  ///< least room left beside and over the pins that the fibre must not
                           ///< touch, and below the top of the pin that holds it
    std::string failure;   ///< empty, or in words what the pins lack
};

/// With more room than this the intended pin is sure to take hold, and no other.
inline constexpr double kMinPinRoom_mm = 0.2;

/// The lead that leaves most room, and the height, where it is not given.
/// \param shape radius, angle, held, pitch, diameter are read
[[nodiscard]] PinFit fit_pins(const PinTurnShape& shape, double strand_mm,
                              std::optional<double> height_mm);

/// The turn as a piece of a plan, with where the free fibre begins (Piece::free_start). Its slip is
/// that of a path without friction: zero, also where pins hold it.
/// \param from how the course before leaves over the rim
[[nodiscard]] LaidTurn turn_on_pins(const Rim& rim, const RimCrossing& from,
                                    const PinTurnShape& shape, double band_mm);

/// The ring with the pins that a turn from there bends about.
[[nodiscard]] PinRing ring_for(const Rim& rim, const RimCrossing& from, const PinTurnShape& shape);

}  // namespace meshwind
