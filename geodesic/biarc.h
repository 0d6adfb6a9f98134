/// Biarc on a surface: a path between two places with given directions at both. It has two
/// stretches, each of constant slip ratio.
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
    SurfacePath path;           ///< of the closest attempt; may be empty
    double slip_ratio = 0.0;    ///< kg / kn of the first half of its length
    double slip_ratio_2 = 0.0;  ///< and of the second
    double miss_mm = 0.0;
    double miss_rad = 0.0;
};

/// Path from `from` to `to` along both tangents: kg = slip_ratio * kn over the first half of the
/// length and slip_ratio_2 * kn over the second, on concave places too, which the caller may not
/// want. Newton's method finds the three unknowns, both ratios and the length, from three
/// conditions, place and direction at the end. It starts from the geodesic between both places.
/// Accuracy: that of the tracer on patches; tests/geodesic/biarc_test.cpp.
[[nodiscard]] Biarc biarc(const Surface& surface, const PathPoint& from, const PathPoint& to,
                          const BiarcOptions& options = {});

}  // namespace meshwind
