/// Judges the fibres of a ring head on the frame: coverage, thickness, angle, slip.
#pragma once

#include <limits>
#include <vector>

#include "postproc/ringhead/ring_laydown.h"
#include "postproc/ringhead/ring_pattern.h"
#include "postproc/ringhead/tube_surface.h"

namespace meshwind {

/// Zone and wanted values for the judgement of laid fibres.
struct RingCoverTask {
    double from_mm = 0.0;  ///< the wound zone along the axis
    double to_mm = 0.0;
    double angle_rad = 0.0;  ///< wanted
    double tow_width_mm = 0.0;
    double settle_mm = 0.0;  ///< nearer than this to a bend an arm is not yet regular
};

/// Areas and layers. A tow is a band of the tow's width about its landing curve. `layers` is the
/// width over the distance of neighbouring curves of one ring, at a right angle to them, summed
/// over the rings: overlaps and gaps between neighbours flow out, fibre is not lost.
struct RingCover {
    double covered = 0.0;         ///< share of the zone's area that lies under a band of each ring
    double widest_mm = 0.0;       ///< largest distance of neighbours: a tow as wide covers
    double mean_layers = 0.0;     ///< of the zone's area
    double regular_cv = 0.0;      ///< standard deviation over mean of the layers on regular arms
    double regular_mm = 0.0;      ///< their length
    double inside_layers = 0.0;   ///< means in the middle half of the bends, on the line inside
    double outside_layers = 0.0;  ///< and outside; 0 where there is no bend
};

/// The rows are kCoverRow_mm apart along the axis and cut round into kCoverCells.
/// \pre from_mm < to_mm; fibres of both rings
[[nodiscard]] RingCover ring_cover(const TubeSurface& tube, const std::vector<RingFibre>& fibres,
                                   const RingCoverTask& task);

inline constexpr double kCoverRow_mm = 1.0;
inline constexpr int kCoverCells = 360;

/// The worst of all fibres within the zone.
struct RingQuality {
    double arm_off_rad = 0.0;   ///< of the angle from the wanted one, on regular arms
    double arm_s_mm = 0.0;      ///< where
    double bend_off_rad = 0.0;  ///< of the angle from even advance (ring_pattern.h), elsewhere
    double bend_s_mm = 0.0;
    double inside_rad = 0.0;   ///< steepest in a bend, from the axis
    double outside_rad = 0.0;  ///< flattest there
    double slip = 0.0;         ///< |kg / kn| over chords as long as the tow is wide, bridges apart
    double slip_s_mm = 0.0;
    double least_kn_per_mm = std::numeric_limits<double>::infinity();  ///< bridges where <= 0
    double least_kn_s_mm = 0.0;
    double ends_short_mm = 0.0;  ///< of the zone that a fibre does not reach, 0 where all do
};

[[nodiscard]] RingQuality ring_quality(const TubeSurface& tube,
                                       const std::vector<RingFibre>& fibres,
                                       const RingCoverTask& task);

/// Radius of the axis' tightest bend; infinity where it is straight. Curvatures below 1e-6 of the
/// tube's count as rounding.
[[nodiscard]] double tightest_bend_mm(const TubeSurface& tube);

}  // namespace meshwind
