/// Hoop plies: a cylinder wound side by side.
#pragma once

#include <vector>

#include "winding/revolution/meridian_path.h"

namespace meshwind {

/// A cylindrical part of a meridian.
struct CylinderPart {
    double from_mm = 0.0;  ///< arc lengths
    double to_mm = 0.0;
    double radius_mm = 0.0;
};

/// The cylinder about a place of a meridian; empty (from = to) where it is curved or slopes there.
[[nodiscard]] CylinderPart cylinder_at(const Meridian& meridian, double arc_mm);

/// The stretch of a meridian between two heights, as wide as at its widest place: the rest of a
/// cylinder under layers. \param low_z_mm, high_z_mm beyond the meridian: as far as it goes
[[nodiscard]] CylinderPart cylinder_between(const Meridian& meridian, double low_z_mm,
                                            double high_z_mm);

/// The stretch of a part on which hoops hold: between the places nearest to its ends where, half a
/// band further in, a hoop is no steeper than `most_slope`. Empty where its middle is steeper.
/// \param most_slope tan(slope) of the meridian, the slip ratio with which a hoop holds, > 0
[[nodiscard]] CylinderPart level_part(const Meridian& meridian, const CylinderPart& part,
                                      double band_mm, double most_slope);

/// One ply over a cylinder from azimuth 0, upward or downward: a whole turn along the hoop half a
/// band from one end, a helix of an even pitch that is at most the band, and a whole turn half a
/// band from the other. Between hoop and helix the path is steered with a constant slip ratio, so
/// that it has no kinks. A cylinder no wider than the band gets one turn in its middle. Where the
/// part is none exactly, the arc lengths over azimuth are those of the cylinder, and angles and
/// fibre lengths those of the radius at each place.
/// \param band_mm > 0 \param slip_ratio > 0, of the steering \param station_mm > 0
[[nodiscard]] std::vector<MeridianStation> hoop_ply(const Meridian& meridian,
                                                    const CylinderPart& part, double band_mm,
                                                    double slip_ratio, double station_mm,
                                                    bool downward = false);

}  // namespace meshwind
