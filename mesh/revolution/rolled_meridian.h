/// Crotches and steps of bodies of revolution filled up, as a shop does it with putty.
#pragma once

#include <optional>
#include <string>

#include "mesh/revolution/meridian.h"

namespace meshwind {

struct RolledMeridian {
    std::optional<Meridian> meridian;  ///< none where there is nothing to fill up, or it cannot be
    double area_mm2 = 0.0;             ///< of the wall that stands over the body's
    double volume_mm3 = 0.0;           ///< filled in
    std::string why_not;               ///< where something would be filled up and cannot be
};

/// The meridian over which a ball of the radius rolls from one end to the other, outside. Where the
/// ball touches the body in two places and nothing in between, its own arc takes the place of what
/// is in between: slopes go on at both, curvatures jump. Nothing else moves. Exact to 1e-6 of the
/// radius, since the ball of a body of revolution touches where the circle in its half plane does.
/// It cannot be filled up where the ball would leave by an end, or cannot get in between two places
/// and yet touches there. \param radius_mm > 0
[[nodiscard]] RolledMeridian rolled_meridian(const Meridian& meridian, double radius_mm);

}  // namespace meshwind
