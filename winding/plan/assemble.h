/// Builds pieces of a plan from finished paths and appends them to the plan.
#pragma once

#include <algorithm>
#include <cstdint>

#include "geodesic/surface_path.h"
#include "mesh/surface.h"
#include "winding/plan/friction.h"
#include "winding/plan/plan.h"
#include "winding/plan/turns.h"

namespace meshwind {

/// Distance of the stations of a plan, the same for all planners.
inline constexpr double kPatternStation_mm = 4.0;

/// Distance on walls of less than 25 mm radius, as a share of the radius: the error of a cubic
/// between two stations is the same share of the radius everywhere.
inline constexpr double kStationShare = 0.16;

/// Its upper bound there in tow widths, as for a tow of 6 mm on larger walls: bands are followed
/// beyond a rim by as much as they are wide.
inline constexpr double kStationTows = 2.0 / 3.0;

[[nodiscard]] inline double station_on_mm(double radius_mm, double tow_mm) {
    const double share_mm = kStationShare * radius_mm;
    return share_mm < kPatternStation_mm ? std::min(share_mm, kStationTows * tow_mm)
                                         : kPatternStation_mm;
}

/// A course along a finished path: its taut string, and slip and kg measured on it.
/// \param path on the patches or the ideal body, with normals, tangents, kn and arc lengths
[[nodiscard]] Piece course_along(const Surface& surface, SurfacePath path, Friction friction);

/// A turn over a rim, with its demands on the rim's extension.
struct LaidTurn {
    Piece piece;
    TurnsAtRim asks;
    std::int32_t rim = -1;
};

/// Appends a piece to the plan and adds its length, slip, bridging and joint to the plan's.
void add_piece(Piece piece, Plan& plan);

/// Appends a turn, with its demands on its rim. \pre plan.turns has an entry for the rim
void add_turn(LaidTurn turn, Plan& plan);

}  // namespace meshwind
