/// Fibres over the domes of a vessel: geodesics, and the slip ratio needed where they do not turn.
#pragma once

#include <optional>

#include "mesh/shapes/isotensoid.h"

namespace meshwind {

/// A geodesic from the equator over the dome and back. At the radius Y its winding angle from the
/// meridian keeps Y sin(alpha) = Clairaut radius; it turns where Y is that radius.
struct DomePass {
    double length_mm = 0.0;  ///< from the equator to the turning circle: half of the way
    double turn_rad = 0.0;   ///< about the axis, from the equator back to the equator
};

/// Length and turn of a geodesic pass, by quadrature in an angle in which both ends are smooth.
/// \pre least radius of the dome < clairaut_mm < radius of its equator
/// Accuracy: 1e-9 of length and turn, geodesics that come within 1e-6 of the least radius
/// excepted, where both grow without bound; tests/winding/vessel/dome_pass_test.cpp.
[[nodiscard]] DomePass geodesic_pass(const IsotensoidDome& dome, double clairaut_mm);

/// A place on any meridian Y(Z) and a fibre through it.
struct MeridianFibre {
    double radius_mm = 0.0;          ///< Y
    double slope = 0.0;              ///< dY/dZ
    double bend_per_mm = 0.0;        ///< d2Y/dZ2
    double angle_rad = 0.0;          ///< from the meridian, towards where Z grows
    double angle_rate_per_mm = 0.0;  ///< by the fibre's length
};

/// Slip ratio kg / kn, > 0 where the fibre turns towards the hoop:
///     (Y A dalpha/ds + Y' sin(alpha)) / (sin^2(alpha) - Y Y'' cos^2(alpha) / A^2),  A^2 = 1 +
///     Y'^2.
/// Eq. (9) and (18) of chen_2023_gas_cylinders lack the term of dalpha/ds: on a geodesic they do
/// not vanish. \pre the surface is not straight along the fibre
[[nodiscard]] double slip_ratio(const MeridianFibre& fibre);

/// The constant slip ratio on the dome, beginning at the equator, by which a fibre with the
/// Clairaut radius `clairaut_mm` there turns at the radius `turn_mm`. Along the meridian the moment
/// m = Y sin(alpha) grows by dm/ds = slip (k_parallel m^2 + k_meridian (Y^2 - m^2)) / Y.
/// \return none: it would take more than 1, or the fibre would lift off a concave stretch
/// \pre 0 < clairaut_mm <= turn_mm, least radius of the dome <= turn_mm < its equator's
/// Accuracy: 1e-8, by its step; tests/winding/vessel/dome_pass_test.cpp on the sphere,
/// vessel_trace_test.cpp on meshes
[[nodiscard]] std::optional<double> slip_to_turn(const IsotensoidDome& dome, double clairaut_mm,
                                                 double turn_mm);

}  // namespace meshwind
