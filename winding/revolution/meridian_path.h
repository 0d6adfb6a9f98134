/// Fibre paths over a body of revolution, by its meridian alone.
#pragma once

#include <vector>

#include "geodesic/surface_path.h"
#include "mesh/revolution/meridian.h"

namespace meshwind {

/// One station of such a path. The winding angle is counted from the meridian's growing arc towards
/// growing azimuth: below pi / 2 upward, above it downward.
struct MeridianStation {
    MeridianPlace place;
    double arc_mm = 0.0;       ///< along the meridian
    double azimuth_rad = 0.0;  ///< about +Z
    double angle_rad = 0.0;
    double s_mm = 0.0;  ///< along the path
    /// Above 0: the fibre is in the air so high over the place, as it goes straight over a hollow
    /// rim (hollow_rim.h); s is along it then, and the angle is that of the way below it.
    double gap_mm = 0.0;
    double slope = 0.0;  ///< rise of the fibre against that way, mm per mm
};

/// Where a path ended: at an end of the meridian, where it runs along a parallel, or because it was
/// long enough.
enum class MeridianStop { End, Hoop, Length };

/// A path from its lower end to its upper one.
struct MeridianPass {
    std::vector<MeridianStation> stations;
    MeridianStop lower = MeridianStop::Length;
    MeridianStop upper = MeridianStop::Length;

    [[nodiscard]] double turn_rad() const {
        return stations.back().azimuth_rad - stations.front().azimuth_rad;
    }
    [[nodiscard]] double length_mm() const { return stations.back().s_mm; }
};

/// Slip ratios of a path: one below the place that it goes through, one above.
struct HalfSlips {
    double below = 0.0;
    double above = 0.0;
};

/// The path through a place, followed upward and downward to where it ends. Its law is
/// kg = slip kn where kn > 0 and kg = 0 elsewhere and near bridges over hollow edges, kg > 0 to the
/// left of travel seen from outside; with the radius r and the meridian's slope psi,
///
///     d arc/ds = cos a,  d azimuth/ds = sin a / r,  da/ds = -sin(psi) sin(a) / r - kg,
///     kn = curvature cos(a)^2 + cos(psi) sin(a)^2 / r
///
/// which for a slip of 0 is Clairaut's r sin(a) = const. Fourth order in the step (Runge-Kutta,
/// a sixteenth of `station_mm`); ends are found to rounding. At a crease there are two stations,
/// one on either side.
/// \param arc_mm of the place, whose azimuth is 0 \param angle_rad there, 0 <= angle < pi / 2
/// \param station_mm distance of stations, > 0 \param longest_mm of either half
[[nodiscard]] MeridianPass pass_through(const Meridian& meridian, double arc_mm, double angle_rad,
                                        const HalfSlips& slip, double station_mm,
                                        double longest_mm);

/// The same with one slip ratio all along.
[[nodiscard]] MeridianPass pass_through(const Meridian& meridian, double arc_mm, double angle_rad,
                                        double slip_ratio, double station_mm, double longest_mm);

/// The path that leaves a parallel, along which it runs, upward or downward; the same law, with the
/// sign of the slip ratio of pass_through. Its stations are in the order of the arc as well: the
/// parallel is the first station or the last. A path that does not leave has only stations there.
[[nodiscard]] MeridianPass pass_from(const Meridian& meridian, double arc_mm, bool upward,
                                     double slip_ratio, double station_mm, double longest_mm);

/// The way back: the same path from its upper end to the lower one, mirrored so that the azimuth
/// grows on. It begins at azimuth 0 and s = 0.
[[nodiscard]] std::vector<MeridianStation> way_back(const MeridianPass& pass);

/// The path point of a station, turned by `turn_rad` about +Z: position, normal and tangent of the
/// surface that the meridian sweeps. kn is the surface's, kg is left at 0, the face at kNoFace.
[[nodiscard]] PathPoint swept(const MeridianStation& station, double turn_rad);

}  // namespace meshwind
