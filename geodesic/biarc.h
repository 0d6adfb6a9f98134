/// The path between two places of the surface that keeps the directions at both: two stretches of
/// constant slip ratio.
#pragma once

#include "geodesic/trace.h"

namespace meshwind {

struct BiarcOptions {
    double longest_mm = 1e4;      ///< > 0; of the whole path
    double max_step_mm = 4.0;     ///< > 0; between two stations
    double tolerance_mm = 1e-3;   ///< > 0; of the miss: far below the width of a band
    double tolerance_rad = 1e-5;  ///< > 0; of the direction at the end
    int max_iterations = 40;      ///< > 0; Newton's method takes fewer than 10 where it converges
};

struct Biarc {
    bool found = false;
    SurfacePath path;           ///< of the nearest try; may be empty
    double slip_ratio = 0.0;    ///< kg / kn of the first half of its length
    double slip_ratio_2 = 0.0;  ///< and of the second
    double miss_mm = 0.0;
    double miss_rad = 0.0;
};

/// From `from` along its tangent to `to`, arriving along its tangent: kg = slip_ratio * kn over the
/// first half of the length and slip_ratio_2 * kn over the second; on concave places too, which the
/// caller may not want. Three unknowns, the ratios and the length, by Newton's method for the three
/// conditions, place and direction at the end, from the geodesic between both places.
/// Accuracy: that of the tracer on patches; tests/geodesic/biarc_test.cpp.
[[nodiscard]] Biarc biarc(const Surface& surface, const PathPoint& from, const PathPoint& to,
                          const BiarcOptions& options = {});

}  // namespace meshwind
