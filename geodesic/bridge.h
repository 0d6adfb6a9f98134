/// Where a straight fibre over a hollow meets the wall again, and paths that are taut over hollows.
#pragma once

#include <optional>
#include <vector>

#include "geodesic/field_walk.h"
#include "geodesic/lifted_wall.h"
#include "geodesic/trace.h"

namespace meshwind {

/// Over hollows a fibre is looked for so far ahead of where it leaves the wall; at the bridging
/// tolerances in use it is back long before.
inline constexpr double kBridgeReach_mm = 40.0;

/// But over no fewer mean edges: where the curvature of a wall jumps, as from a dome to a cylinder,
/// its patches are hollow by some hundredths of a mm over an edge, and fibre that runs nearly along
/// the cylinder lands some edges further on.
inline constexpr double kBridgeReachEdges = 6.0;

/// The longer of the two on a surface.
[[nodiscard]] double bridge_reach_mm(const Surface& surface);

/// A straight stretch of fibre over the wall.
struct Bridge {
    SurfacePath under;           ///< n >= 1: the wall below, s_mm from where the fibre leaves it;
                                 ///< the last station is where the fibre meets it again
    std::vector<double> gap_mm;  ///< n, height of the fibre over the stations; the last is 0
    FieldWalker far;             ///< at the last station
};

/// Follows the straight fibre that leaves the wall at `from` along the unit vector `along`, over
/// the wall below it, and takes the place that stands highest, seen from `from`: there the fibre
/// touches. Nothing where the wall stays below the fibre over `reach_mm`.
/// \param lifted of the same surface, where it is at hand: no other bridge is found, but sooner
[[nodiscard]] std::optional<Bridge> bridge_ahead(const Surface& surface, const FieldWalker& from,
                                                 const Eigen::Vector3d& along, double reach_mm,
                                                 const LiftedWall* lifted = nullptr);

/// trace() by TraceMethod::Patches of the path that a taut fibre takes: where its tangent meets the
/// wall further on it leaves the wall, runs straight, and goes on from there in the direction in
/// which it arrives. Stations under such bridges lie on the wall, their tangents are those of the
/// straight fibre over it. Bridges of less than kMinBridge_mm are left as the path over the wall.
[[nodiscard]] TraceResult trace_taut(const Surface& surface, const SurfacePoint& start,
                                     const Eigen::Vector3d& direction, const Steering& steering,
                                     const TraceOptions& options,
                                     const LiftedWall* lifted = nullptr);

inline constexpr double kMinBridge_mm = 0.002;

}  // namespace meshwind
