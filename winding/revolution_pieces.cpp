#include "winding/revolution_pieces.h"

#include <algorithm>
#include <utility>

#include "geodesic/field_walk.h"
#include "geodesic/measure.h"
#include "winding/lay_out.h"

namespace meshwind {

using Eigen::Vector3d;

RevolutionPieces::RevolutionPieces(const Mandrel& mandrel, const BodyOfRevolution& body,
                                   const TurnRule& rule)
    : mandrel_(mandrel), body_(body), rule_(rule) {
    const Surface& surface = mandrel.surface;
    const auto point = [&](std::int32_t i) {
        return surface.position_mm[static_cast<std::size_t>(i)];
    };
    std::vector<Vector3d> centres;
    for (const auto& [a, b, c] : surface.face) {
        centres.push_back((point(a) + point(b) + point(c)) / 3.0);
    }
    nearest_.emplace(centres);
}

const Rim* RevolutionPieces::rim_of(std::size_t end) const {
    const std::int32_t rim = body_.end[end].rim;
    return rim >= 0 ? &mandrel_.rims[static_cast<std::size_t>(rim)] : nullptr;
}

RimCrossing RevolutionPieces::crossing_of(std::size_t end, const MeridianStation& place,
                                          double turn_rad) const {
    const PathPoint point = swept(place, turn_rad);
    return crossing_at(*rim_of(end), point.position_mm,
                       end == 0 ? Vector3d(-point.tangent) : point.tangent);
}

SurfacePath RevolutionPieces::path(const std::vector<MeridianStation>& stations,
                                   double turn_rad) const {
    SurfacePath path;
    std::optional<FieldWalker> walker;
    for (const MeridianStation& station : stations) {
        PathPoint point = swept(station, turn_rad);
        if (!walker || !walker->move_under(point.position_mm)) {
            // On a rim the place may lie just beyond.
            walker.emplace(mandrel_.surface, SurfacePoint{nearest_->nearest(point.position_mm)});
            (void)walker->move_under(point.position_mm);
        }
        point.at = walker->station(point.tangent).at;
        path.push_back(point);
    }
    return path;
}

Piece RevolutionPieces::course(const std::vector<MeridianStation>& stations,
                               double turn_rad) const {
    Piece piece;
    piece.kind = PieceKind::Course;
    piece.path = path(stations, turn_rad);
    piece.string = taut_string(piece.path);
    const SlipMeasure slip =
        measure_slip(mandrel_.surface, piece.path, piece.string,
                     {.friction = rule_.friction, .method = TraceMethod::Patches});
    for (std::size_t i = 0; i < piece.path.size(); ++i) {
        piece.path[i].kg_per_mm = slip.kg_per_mm[i];
    }
    piece.slip = slip.slip;
    piece.worst_slip = slip.worst;
    return piece;
}

LaidTurn RevolutionPieces::turn(std::size_t end, const PathPoint& from, const PathPoint& to) const {
    const Rim& rim = *rim_of(end);
    Turn turn = make_turn(rim, crossing_at(rim, from.position_mm, from.tangent),
                          crossing_at(rim, to.position_mm, -to.tangent), rule_, kPatternStation_mm);
    const TurnsAtRim asks{1, turn.run_mm + 0.5 * rule_.band_mm, turn.dwell_rad};
    return {piece_of_turn(std::move(turn), rim.id), asks, rim.id};
}

}  // namespace meshwind
