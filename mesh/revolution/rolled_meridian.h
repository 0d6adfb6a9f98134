/// Fillets crotches and steps of bodies of revolution, as a shop does with putty.
#pragma once

#include <optional>
#include <string>

#include "mesh/revolution/meridian.h"

namespace meshwind {

struct RolledMeridian {
    std::optional<Meridian>
        meridian;             ///< none where there is nothing to fill up, or filling is impossible
    double area_mm2 = 0.0;    ///< of the wall that stands over the body's
    double volume_mm3 = 0.0;  ///< filled in
    std::string why_not;      ///< why a place cannot be filled up; else empty
};

/// The meridian over which a ball of the radius rolls from one end to the other, outside. Where the
/// ball touches the body in two places and nothing in between, its own arc replaces the meridian in
/// between: slopes are continuous at both, curvatures jump. Nothing else moves. Exact to 1e-6 of
/// the radius, since the ball of a body of revolution touches where the circle in its half plane
/// does. Filling is impossible where the ball would leave by an end, or cannot get in between two
/// places and yet touches there. \param radius_mm > 0
[[nodiscard]] RolledMeridian rolled_meridian(const Meridian& meridian, double radius_mm);

}  // namespace meshwind
