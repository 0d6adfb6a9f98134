#include "winding/revolution_pieces.h"

#include <utility>

namespace meshwind {

using Eigen::Vector3d;

RevolutionPieces::RevolutionPieces(const Mandrel& mandrel, const BodyOfRevolution& body,
                                   const TurnRule& rule)
    : mandrel_(mandrel), body_(body), rule_(rule), projection_(mandrel.surface) {}

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

Piece RevolutionPieces::course(const std::vector<MeridianStation>& stations,
                               double turn_rad) const {
    SurfacePath path;
    for (const MeridianStation& station : stations) {
        path.push_back(swept(station, turn_rad));
    }
    projection_.put(path);
    return course_along(mandrel_.surface, std::move(path), rule_.friction);
}

LaidTurn RevolutionPieces::turn(std::size_t end, const PathPoint& from, const PathPoint& to) const {
    return turn_over(*rim_of(end), from, to, rule_);
}

}  // namespace meshwind
