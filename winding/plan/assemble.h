/// Pieces of a plan from finished paths, and how they are put together.
#pragma once

#include <algorithm>
#include <cstdint>

#include "geodesic/surface_path.h"
#include "mesh/surface.h"
#include "winding/plan/friction.h"
#include "winding/plan/plan.h"
#include "winding/plan/turns.h"

namespace meshwind {

/// Distance of the stations of a plan, as the other planners have it.
inline constexpr double kPatternStation_mm = 4.0;

/// On walls of less than 25 mm radius so much of it: what a cubic between two stations is off is
/// the same share of the radius everywhere.
inline constexpr double kStationShare = 0.16;

/// And there no more than so much of the tow, as a tow of 6 mm has it on larger ones: bands are
/// followed beyond a rim by as much as they are wide.
inline constexpr double kStationTows = 2.0 / 3.0;

[[nodiscard]] inline double station_on_mm(double radius_mm, double tow_mm) {
    const double share_mm = kStationShare * radius_mm;
    return share_mm < kPatternStation_mm ? std::min(share_mm, kStationTows * tow_mm)
                                         : kPatternStation_mm;
}

/// A course along a finished path: its taut string, and slip and kg measured on it.
/// \param path on the patches or the ideal body, with normals, tangents, kn and arc lengths
[[nodiscard]] Piece course_along(const Surface& surface, SurfacePath path, Friction friction);

/// A turn over a rim, and what it asks of the rim's extension.
struct LaidTurn {
    Piece piece;
    TurnsAtRim asks;
    std::int32_t rim = -1;
};

/// Puts a piece at the plan's end and adds its length, slip, bridging and joint to the plan's.
void add_piece(Piece piece, Plan& plan);

/// The same of a turn, with what it asks of its rim. \pre plan.turns has an entry for the rim
void add_turn(LaidTurn turn, Plan& plan);

}  // namespace meshwind
