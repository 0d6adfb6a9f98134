/// Layers of nearly hoop windings on a cylinder, in whole turns.
#pragma once

#include <cstdint>

namespace meshwind {

/// A layer of nearly hoop windings between two edges, wound to and fro.
struct HoopRequest {
    double radius_mm = 0.0;
    double length_mm = 0.0;      ///< from edge to edge; > band
    double band_mm = 0.0;        ///< < 2 pi radius
    int passes = 1;              ///< > 0: layers
    double least_overlap = 0.0;  ///< > -1: share of the band; below 0 a gap
};

/// The centre of the band stands still for one turn half a band from each edge, so that the edge is
/// covered all around, and advances by whole turns in between: every pass begins and ends at the
/// same place around the mandrel.
struct HoopLayer {
    std::int64_t turns = 0;  ///< per pass, while advancing
    double pitch_mm = 0.0;   ///< (length - band) / turns
    double angle_rad = 0.0;  ///< from the axis, atan(2 pi R / pitch)
    double overlap = 0.0;    ///< band / (pitch sin(angle)) - 1
    std::int64_t passes = 0;
    double total_rad = 0.0;  ///< passes * turns, and one turn more at passes + 1 edges
};

/// The fewest turns that cover. \throws InputError pattern.out_of_range
[[nodiscard]] HoopLayer hoop_layer(const HoopRequest& request);

}  // namespace meshwind
