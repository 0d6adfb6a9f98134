#include "winding/wall.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "geodesic/measure.h"
#include "winding/lay_out.h"

namespace meshwind {

namespace {

// Of the circle that turns as much from one station to the next.
double arc_between_mm(const PathPoint& a, const PathPoint& b) {
    const double chord = (b.position_mm - a.position_mm).norm();
    const double half =
        0.5 * std::atan2(a.tangent.cross(b.tangent).norm(), a.tangent.dot(b.tangent));
    return half > 0.0 ? chord * half / std::sin(half) : chord;
}

}  // namespace

Wall::Wall(const Surface& surface) : surface_(surface) {
    const auto point = [&](std::int32_t i) {
        return surface.position_mm[static_cast<std::size_t>(i)];
    };
    std::vector<Eigen::Vector3d> centres;
    for (const auto& [a, b, c] : surface.face) {
        centres.emplace_back((point(a) + point(b) + point(c)) / 3.0);
    }
    nearest_.emplace(centres);
}

void Wall::move_under(const Eigen::Vector3d& place_mm, std::optional<FieldWalker>& walker) const {
    if (!walker || !walker->move_under(place_mm)) {
        // On a rim the place may lie just beyond.
        walker.emplace(surface_, SurfacePoint{nearest_->nearest(place_mm)});
        (void)walker->move_under(place_mm);
    }
}

void Wall::put(SurfacePath& path) const {
    std::optional<FieldWalker> walker;
    for (PathPoint& point : path) {
        move_under(point.position_mm, walker);
        point.at = walker->station(point.tangent).at;
    }
}

void Wall::settle(
    SurfacePath& path,
    const std::function<Eigen::Vector3d(std::size_t i, const Eigen::Vector3d& position)>& direction)
    const {
    std::optional<FieldWalker> walker;
    for (std::size_t i = 0; i < path.size(); ++i) {
        move_under(path[i].position_mm, walker);
        path[i] = walker->station(direction(i, walker->position_mm()));
        if (i > 0) {
            path[i].s_mm = path[i - 1].s_mm + arc_between_mm(path[i - 1], path[i]);
        }
    }
}

Piece course_along(const Surface& surface, SurfacePath path, double friction) {
    Piece piece;
    piece.kind = PieceKind::Course;
    piece.string = taut_string(path);
    const SlipMeasure slip = measure_slip(surface, path, piece.string,
                                          {.friction = friction, .method = TraceMethod::Patches});
    for (std::size_t i = 0; i < path.size(); ++i) {
        path[i].kg_per_mm = slip.kg_per_mm[i];
    }
    piece.slip = slip.slip;
    piece.worst_slip = slip.worst;
    piece.path = std::move(path);
    return piece;
}

LaidTurn turn_over(const Rim& rim, const PathPoint& from, const PathPoint& to,
                   const TurnRule& rule) {
    Turn turn = make_turn(rim, crossing_at(rim, from.position_mm, from.tangent),
                          crossing_at(rim, to.position_mm, -to.tangent), rule, kPatternStation_mm);
    const TurnsAtRim asks{1, turn.run_mm + 0.5 * rule.band_mm, turn.dwell_rad};
    return {piece_of_turn(std::move(turn), rim.id), asks, rim.id};
}

void add_piece(Piece piece, Plan& plan) {
    if (!plan.pieces.empty()) {
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
