/// Crossings of rims by courses, and the demands of turns on the rims' extensions.
#pragma once

#include <cstdint>

namespace meshwind {

/// How a course meets a rim, seen with the rim's axis pointing away from the mandrel.
struct RimCrossing {
    std::int32_t rim = -1;
    double azimuth_rad = 0.0;  ///< about the axis, counter-clockwise, from `rim_reference`
    double angle_rad = 0.0;    ///< beta between fibre and axis, 0 = axial, pi/2 = hoop
    int sense = 0;             ///< +1 when the fibre leaves the mandrel counter-clockwise, else -1
    /// >= 0: angle about the axis over which the fibre runs straight through the air before it lies
    /// on the extension; above 0 over hollow rims (hollow_rim.h).
    double ahead_rad = 0.0;
};

/// Demands of a plan's turns on one rim's extension.
struct TurnsAtRim {
    int turns = 0;
    double extension_mm = 0.0;  ///< axial length that they and the band need
    double dwell_rad = 0.0;     ///< wound along hoops, in all
};

/// Pins evenly spaced around a rim's extension.
struct PinRing {
    std::int32_t rim = -1;
    int count = 0;
    double diameter_mm = 2.0;
    double height_mm = 5.0;
    double strand_mm = 0.0;
    double offset_mm = 0.0;    ///< of the axes from the rim, onto the extension
    double azimuth_rad = 0.0;  ///< of one of them, from rim_reference (turn.h)
    int skip = 0;              ///< pins that a turn runs behind
};

}  // namespace meshwind
