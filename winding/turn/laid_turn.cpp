#include "winding/turn/laid_turn.h"

#include <cmath>
#include <utility>

namespace meshwind {

Piece piece_of_turn(Turn&& turn, std::int32_t rim) {
    Piece piece;
    piece.kind = PieceKind::Transition;
    piece.string = std::move(turn.string);
    for (const PathPoint& point : turn.path) {
        piece.slip.push_back(std::abs(point.kg_per_mm) / point.kn_per_mm);
    }
    piece.worst_slip = turn.slip;
    piece.path = std::move(turn.path);
    piece.start_rim = rim;
    piece.end_rim = rim;
    return piece;
}

LaidTurn turn_over(const Rim& rim, const PathPoint& from, const PathPoint& to,
                   const TurnRule& rule) {
    return turn_over(rim, crossing_at(rim, from.position_mm, from.tangent),
                     crossing_at(rim, to.position_mm, -to.tangent), rule);
}

LaidTurn turn_over(const Rim& rim, const RimCrossing& from, const RimCrossing& to,
                   const TurnRule& rule) {
    Turn turn = make_turn(rim, from, to, rule, station_on_mm(rim.radius_mm, rule.band_mm));
    const TurnsAtRim asks{1, turn.run_mm + 0.5 * rule.band_mm, turn.dwell_rad};
    return {piece_of_turn(std::move(turn), rim.id), asks, rim.id};
}

}  // namespace meshwind
