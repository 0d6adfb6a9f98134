#include "winding/revolution/revolution_pieces.h"

#include <algorithm>
#include <utility>

#include "core/units.h"
#include "winding/cover/lay_out_plan.h"
#include "winding/revolution/aim_pass.h"
#include "winding/turn/laid_turn.h"

namespace meshwind {

using Eigen::Vector3d;

RevolutionPieces::RevolutionPieces(const Mandrel& mandrel, const BodyOfRevolution& body,
                                   const TurnRule& rule)
    : mandrel_(mandrel), body_(body), rule_(rule), projection_(mandrel.surface) {
    const Meridian& meridian = body.meridian;
    double radius_mm = meridian.at(meridian.widest_mm()).radius_mm;
    for (std::size_t end = 0; end < 2; ++end) {
        const double end_mm = end == 0 ? 0.0 : meridian.length_mm();
        if (rim_of(end) != nullptr && cap_mm(body, end) == end_mm) {
            radius_mm = std::min(radius_mm, rim_of(end)->radius_mm);
        }
    }
    station_mm_ = station_on_mm(radius_mm, rule_.band_mm);
}

const Rim* RevolutionPieces::rim_of(std::size_t end) const {
    const std::int32_t rim = body_.end[end].rim;
    return rim >= 0 ? &mandrel_.rims[static_cast<std::size_t>(rim)] : nullptr;
}

RimCrossing RevolutionPieces::crossing_of(std::size_t end, const MeridianStation& place,
                                          double turn_rad) const {
    const PathPoint point = swept(place, turn_rad);
    const bool upward = place.angle_rad < 0.5 * kPi;
    const double out = upward == (end == 1) ? 1.0 : -1.0;
    if (place.gap_mm > 0.0) {
        const Vector3d along = (point.tangent + place.slope * point.normal).normalized();
        return crossing_in_air(*rim_of(end), point.position_mm, out * along);
    }
    return crossing_at(*rim_of(end), point.position_mm, out * point.tangent);
}

Piece RevolutionPieces::course(const std::vector<MeridianStation>& stations,
                               double turn_rad) const {
    SurfacePath path;
    for (const MeridianStation& station : stations) {
        path.push_back(swept(station, turn_rad));
    }
    projection_.put(path);
    const auto on_wall = [](const MeridianStation& at) { return at.gap_mm <= 0.0; };
    const auto first = std::find_if(stations.begin(), stations.end(), on_wall);
    const auto last = std::find_if(stations.rbegin(), stations.rend(), on_wall).base();
    if (first == stations.begin() && last == stations.end()) {
        return course_along(mandrel_.surface, std::move(path), rule_.friction);
    }
    const auto begin = static_cast<std::size_t>(first - stations.begin());
    const auto end = static_cast<std::size_t>(last - stations.begin());
    return with_ends_in_air(stations, path, begin, end);
}

// Slip is that of the part on the wall.
Piece RevolutionPieces::with_ends_in_air(const std::vector<MeridianStation>& stations,
                                         const SurfacePath& path, std::size_t begin,
                                         std::size_t end) const {
    SurfacePath laid(path.begin() + static_cast<std::ptrdiff_t>(begin),
                     path.begin() + static_cast<std::ptrdiff_t>(end));
    const double s0 = laid.front().s_mm;
    for (PathPoint& point : laid) {
        point.s_mm -= s0;
    }
    const Piece wall = course_along(mandrel_.surface, std::move(laid), rule_.friction);
    Piece piece;
    piece.path = path;
    piece.worst_slip = wall.worst_slip;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const bool on_wall = i >= begin && i < end;
        const std::size_t k = i - begin;
        piece.path[i].kg_per_mm = on_wall ? wall.path[k].kg_per_mm : 0.0;
        piece.slip.push_back(on_wall ? wall.slip[k] : 0.0);
        const double gap_mm = on_wall ? wall.string.gap_mm[k] : stations[i].gap_mm;
        piece.string.gap_mm.push_back(gap_mm);
        piece.string.slope.push_back(on_wall ? wall.string.slope[k] : stations[i].slope);
        if (gap_mm > piece.string.worst_gap_mm) {
            piece.string.worst_gap_mm = gap_mm;
            piece.string.worst_station = i;
        }
    }
    return piece;
}

LaidTurn RevolutionPieces::turn(std::size_t end, const RimCrossing& from,
                                const RimCrossing& to) const {
    return turn_over(*rim_of(end), from, to, rule_);
}

LaidTurn RevolutionPieces::run_out(std::size_t end, const RimCrossing& from,
                                   double length_mm) const {
    const Rim& rim = *rim_of(end);
    Turn out = meshwind::run_out(rim, from, length_mm, station_on_mm(rim.radius_mm, rule_.band_mm));
    const TurnsAtRim asks{0, out.run_mm + 0.5 * rule_.band_mm, 0.0};
    return {piece_of_turn(std::move(out), rim.id), asks, rim.id};
}

}  // namespace meshwind
