/// Paths of constant slip ratio over a body of revolution, between two turning parallels.
#pragma once

#include <optional>

#include "mesh/revolution/meridian.h"
#include "winding/revolution/meridian_path.h"

namespace meshwind {

/// End of a path of constant slip ratio along the meridian.
struct SteeredEnd {
    double arc_mm = 0.0;
    double turning_mm = 0.0;  ///< c = r sin(a) there
    bool turned = false;      ///< it runs along the parallel there, c = r; else it came all the way
    double most_sine = 0.0;   ///< of its angle to the meridian on the way, at steps; 1 at a turn
};

/// Follows c = r sin(a) along the meridian, which needs no azimuth and is regular where the path
/// turns. With kn > 0 (elsewhere c stays as it is)
///
///     dc/d arc = -slip r kn = -slip (curvature (r^2 - c^2) / r + cos(psi) c^2 / r^2)
///
/// from the laws of meridian_path.h: with slip > 0 it falls with growing arc. On a cylinder that is
/// d(1 / sin a)/dz = slip / R, on a cone r = r0 - t z d(1 / c)/d(1 / r) = slip / t: the sine's
/// inverse is linear in r there. At creases c does not change, nor near bridges over hollow ones
/// (concave_creases.h). Fourth order in steps of 0.25 mm, which end at the meridian's nodes; the
/// turn is found to rounding. \param arc_mm where the path is, with c = turning_mm <= r; at c = r
/// it leaves from a turn \param to_arc_mm up to where it is followed, upward or downward
[[nodiscard]] SteeredEnd steer_from(const Meridian& meridian, double arc_mm, double turning_mm,
                                    double slip_ratio, double to_arc_mm);

/// The place nearest to the widest one, on its way to the lower or upper end, at which the meridian
/// is as narrow as a radius; none where it is wider everywhere.
[[nodiscard]] std::optional<double> narrow_place_mm(const Meridian& meridian, double radius_mm,
                                                    bool upper);

/// Both ends of a steered pass, and its limits.
struct SteeringTask {
    double lower_mm = 0.0;   ///< > 0: radius of the parallel at which it turns below
    double upper_mm = 0.0;   ///< > 0: and above
    double most_slip = 0.0;  ///< >= 0: largest slip ratio, either way
    double station_mm = 4.0;
    double longest_mm = 1e5;  ///< of either half of the pass
};

struct SteeredPass {
    MeridianPass pass;
    double angle_rad = 0.0;   ///< winding angle at the widest place
    double slip_ratio = 0.0;  ///< kg / kn all along, see pass_through
};

struct SteeringFinding {
    std::optional<SteeredPass> found;
    /// Without one: the radius at which it would turn above with the most slip that helps; 0 where
    /// it would not turn at all, and where the body is at an end nowhere as narrow as asked.
    double reached_mm = 0.0;
};

/// The pass with a constant slip ratio between two turns, each at the parallel nearest to the
/// widest place that has its radius. The slip is the root of a function that falls with it, found
/// to rounding (toms748); both radii are then met by the pass itself within 1e-6 mm.
/// Equal radii where a geodesic leads from one to the other are met without slip.
[[nodiscard]] SteeringFinding steer_between(const Meridian& meridian, const SteeringTask& task);

}  // namespace meshwind
