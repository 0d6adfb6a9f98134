/// Measures bridging (a height) and slip (a ratio) of a finished path under tension.
#pragma once

#include "geodesic/trace.h"

namespace meshwind {

/// The taut string over a path: the least concave majorant of the path's height w(s) over the
/// straight line, w'' = -kn with a kink of the crease angle at feature edges: the convex hull of
/// the path in its own normal section. Exact in the flat limit; for a string that turns by theta
/// between touching points the height is off by theta^2 / 4 of itself.
[[nodiscard]] TautString taut_string(const SurfacePath& path);

struct SlipOptions {
    double window_mm = 0.0;  ///< longest half length of the chords; 0: by the rule below
    double friction = 0.2;   ///< where kn is too small for a ratio, the limit that must hold
    TraceMethod method = TraceMethod::Walk;  ///< by which the path was traced; sets its scatter
};

/// kg from the turn between the chords of +-window about each station, seen along the smooth
/// normal; kn from the string's height over the same three points. The path is unfolded at feature
/// edges first. The window is as long as it takes for the sideways scatter of the path's positions
/// to stay below 5 % of what the friction can hold, so it grows with the radius; it is at least one
/// mean edge and shorter where the path turns by more than 0.5 rad along it. Where kn is so small
/// that a string with it sags less than that scatter over the window, a ratio has no meaning: there
/// the station counts as straight if its |kg| is within the scatter, and with the ratio of |kg| to
/// the scatter's curvature otherwise. Nothing is measured nearer to an end than half an edge.
/// Accuracy: tests/geodesic/slip_and_bridging_test.cpp.
[[nodiscard]] SlipMeasure measure_slip(const Surface& surface, const SurfacePath& path,
                                       const TautString& string, const SlipOptions& options = {});

}  // namespace meshwind
