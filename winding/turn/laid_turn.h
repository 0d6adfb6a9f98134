/// Friction turns over rims as pieces of a plan.
#pragma once

#include <cstdint>

#include "geodesic/surface_path.h"
#include "mesh/rim.h"
#include "winding/plan/assemble.h"
#include "winding/turn/turn.h"

namespace meshwind {

/// A turn at a rim as a piece.
[[nodiscard]] Piece piece_of_turn(Turn&& turn, std::int32_t rim);

/// The turn from where a course leaves over a rim to where the next one comes back.
/// \pre both can be turned (can_turn)
[[nodiscard]] LaidTurn turn_over(const Rim& rim, const RimCrossing& from, const RimCrossing& to,
                                 const TurnRule& rule);
[[nodiscard]] LaidTurn turn_over(const Rim& rim, const PathPoint& from, const PathPoint& to,
                                 const TurnRule& rule);

}  // namespace meshwind
