#include "winding/plan/assemble.h"

#include <algorithm>
#include <utility>

#include "geodesic/slip_and_bridging.h"

namespace meshwind {

Piece course_along(const Surface& surface, SurfacePath path, Friction friction) {
    Piece piece;
    piece.kind = PieceKind::Course;
    piece.string = taut_string(path);
    const SlipMeasure slip =
        measure_slip(surface, path, piece.string,
                     {.friction = friction.holds(), .method = TraceMethod::Patches});
    for (std::size_t i = 0; i < path.size(); ++i) {
        path[i].kg_per_mm = slip.kg_per_mm[i];
    }
    piece.slip = slip.slip;
    piece.worst_slip = slip.worst;
    piece.path = std::move(path);
    return piece;
}

void add_piece(Piece piece, Plan& plan) {
    if (!plan.pieces.empty() && !piece.starts_fibre) {
        const Eigen::Vector3d gap =
            piece.path.front().position_mm - plan.pieces.back().path.back().position_mm;
        plan.worst_joint_mm = std::max(plan.worst_joint_mm, gap.norm());
    }
    plan.fibre_length_mm += piece.path.back().s_mm;
    plan.worst_slip = std::max(plan.worst_slip, piece.worst_slip);
    plan.worst_bridge_mm = std::max(plan.worst_bridge_mm, piece.string.worst_gap_mm);
    plan.pieces.push_back(std::move(piece));
}

void add_turn(LaidTurn turn, Plan& plan) {
    TurnsAtRim& turns = plan.turns[static_cast<std::size_t>(turn.rim)];
    turns.turns += turn.asks.turns;
    turns.dwell_rad += turn.asks.dwell_rad;
    turns.extension_mm = std::max(turns.extension_mm, turn.asks.extension_mm);
    add_piece(std::move(turn.piece), plan);
}

}  // namespace meshwind
