/// Hoop plies: a cylinder wound side by side.
#pragma once

#include <vector>

#include "winding/meridian_path.h"

namespace meshwind {

/// A cylindrical part of a meridian.
struct CylinderPart {
    double from_mm = 0.0;  ///< arc lengths
    double to_mm = 0.0;
    double radius_mm = 0.0;
};

/// The cylinder about a place of a meridian; empty (from = to) where it is curved or slopes there.
[[nodiscard]] CylinderPart cylinder_at(const Meridian& meridian, double arc_mm);

/// One ply over a cylinder, upward from azimuth 0: a whole turn along the hoop half a band from the
/// lower end, a helix of an even pitch that is at most the band, and a whole turn half a band from
/// the upper end. Between hoop and helix the path is steered with a constant slip ratio, so that it
/// has no kinks. A cylinder no wider than the band gets one turn in its middle.
/// \param band_mm > 0 \param slip_ratio > 0, of the steering \param station_mm > 0
[[nodiscard]] std::vector<MeridianStation> hoop_ply(const Meridian& meridian,
                                                    const CylinderPart& part, double band_mm,
                                                    double slip_ratio, double station_mm);

/// The next ply, downward, from azimuth 0: the mirror image.
[[nodiscard]] std::vector<MeridianStation> mirrored_ply(const Meridian& meridian,
                                                        std::vector<MeridianStation> ply);

}  // namespace meshwind
