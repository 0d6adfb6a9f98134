/// Bridging over hollows: the landing point of a lifted fibre, and the trace of a taut fibre.
#pragma once

#include <optional>
#include <vector>

#include "geodesic/field_walk.h"
#include "geodesic/lifted_wall.h"
#include "geodesic/trace.h"

namespace meshwind {

/// Distance ahead of the lift-off point in which a landing point is searched; at the bridging
/// tolerances in use the fibre lands long before.
inline constexpr double kBridgeReach_mm = 40.0;

/// Least such distance in mean edges: where the curvature of a wall jumps, as from a dome to a
/// cylinder, its patches are hollow by some hundredths of a mm over an edge, and fibre that runs
/// nearly along the cylinder lands some edges further on.
inline constexpr double kBridgeReachEdges = 6.0;

/// Search distance on a surface: the longer of the two.
[[nodiscard]] double bridge_reach_mm(const Surface& surface);

/// A straight stretch of fibre over the wall.
struct Bridge {
    SurfacePath under;           ///< n >= 1: the wall below, s_mm from where the fibre leaves it;
                                 ///< the last station is where the fibre meets it again
    std::vector<double> gap_mm;  ///< n, height of the fibre over the stations; the last is 0
    FieldWalker far;             ///< at the last station
};

/// Finds the landing point of the straight fibre that leaves the wall at `from` along the unit
/// vector `along`: the place of the wall below it that stands highest, seen from `from`. Nothing
/// where the wall stays below the fibre over `reach_mm`.
/// \param lifted of the same surface, or null: it only makes the search faster, the bridge is the
/// same
[[nodiscard]] std::optional<Bridge> bridge_ahead(const Surface& surface, const FieldWalker& from,
                                                 const Eigen::Vector3d& along, double reach_mm,
                                                 const LiftedWall* lifted = nullptr);

/// Traces a taut fibre by TraceMethod::Patches: where its tangent meets the wall further on it
/// leaves the wall, runs straight, and goes on in the direction in which it arrives. Stations under
/// such bridges lie on the wall, their tangents are those of the straight fibre over it. Bridges of
/// less than kMinBridge_mm are left as the path over the wall.
[[nodiscard]] TraceResult trace_taut(const Surface& surface, const SurfacePoint& start,
                                     const Eigen::Vector3d& direction, const Steering& steering,
                                     const TraceOptions& options,
                                     const LiftedWall* lifted = nullptr);

inline constexpr double kMinBridge_mm = 0.002;

}  // namespace meshwind
