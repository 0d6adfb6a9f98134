/// Angle units. Inside the code angles are radians; degrees live in files, NC code and on the
/// command line.
#pragma once

#include <numbers>

namespace meshwind {

inline constexpr double kPi = std::numbers::pi;

[[nodiscard]] constexpr double rad_from_deg(double deg) {
    return deg * (kPi / 180.0);
}

[[nodiscard]] constexpr double deg_from_rad(double rad) {
    return rad * (180.0 / kPi);
}

}  // namespace meshwind
