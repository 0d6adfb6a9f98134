#include "winding/placed_course.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace meshwind {

using Eigen::Vector3d;

std::size_t seed_station(const PlacedCourse& course) {
    const auto found = std::find_if(
        course.path.begin(), course.path.end(),
        [&](const PathPoint& point) { return point.at.face == course.member.candidate.seed.face; });
    return static_cast<std::size_t>(std::min(found, course.path.end() - 1) - course.path.begin());
}

Candidate moved(const CourseRules& rules, const PlacedCourse& course, std::size_t station,
                const CourseMove& move) {
    const Surface& surface = rules.mandrel.surface;
    const Candidate& from = course.member.candidate;
    const PathPoint& start = course.path[station];
    const Vector3d left = start.normal.cross(start.tangent);
    const double side = move.left_mm < 0.0 ? -1.0 : 1.0;
    const TraceResult way = trace(surface, start.at, side * left, {},
                                  {.max_length_mm = std::max(std::abs(move.left_mm), 1e-3)});
    const PathPoint& place = way.path.back();
    const Vector3d normal = smooth_normal(surface, place.at);
    const double most = kMostSteering * rules.tow.friction;
    const double ahead = std::clamp(from.slip_ratio + move.steering, -most, most);
    const double behind = std::clamp(from.slip_ratio + from.more_behind + move.behind, -most, most);
    return {place.at, direction_angle(normal, side * place.tangent.cross(normal)) + move.turn_rad,
            ahead, behind - ahead};
}

}  // namespace meshwind
