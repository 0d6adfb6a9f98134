#include "winding/cover/placed_course.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/margins.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Spread of a nudge at its widest: sideways in bands, turned in rad, steered in shares of the
// friction. Its narrowest is this many times less.
constexpr double kNudgeBands = 1.0;
constexpr double kNudgeTurn_rad = 0.1;
constexpr double kNudgeSteering = 0.1;
constexpr double kNudgeRange = 16.0;

// Neighbours are turned by this much at most, on some of the draws.
constexpr double kBesideTurn_rad = 0.02;

// From any of its stations. Where it is steered in two ways, from the one where they meet.
Candidate moved_from_any(const CourseRules& rules, const PlacedCourse& course,
                         const CourseMove& move, Draws& draws) {
    const std::size_t any = draws.below(course.path.size());
    const bool anywhere = course.member.candidate.more_behind == 0.0;
    return moved(rules, course, anywhere ? any : seed_station(course), move);
}

}  // namespace

std::vector<std::int32_t> layers_of(std::span<const PlacedCourse> courses, std::size_t samples) {
    std::vector<std::int32_t> layers(samples, 0);
    for (const PlacedCourse& course : courses) {
        for (const std::int32_t sample : course.member.footprint) {
            ++layers[static_cast<std::size_t>(sample)];
        }
    }
    return layers;
}

std::size_t seed_station(const PlacedCourse& course) {
    // Not just the first in the seed's face: a course may pass that several times.
    const SurfacePoint& seed = course.member.candidate.seed;
    std::size_t best = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < course.path.size(); ++i) {
        const SurfacePoint& at = course.path[i].at;
        const double distance = at.face == seed.face ? (at.bary - seed.bary).squaredNorm()
                                                     : std::numeric_limits<double>::max();
        if (distance < nearest) {
            nearest = distance;
            best = i;
        }
    }
    return best;
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
    const double most = rules.tow.friction.share(margin::kCoverSteering);
    const double ahead = std::clamp(from.slip_ratio + move.steering, -most, most);
    const double behind = std::clamp(from.slip_ratio + from.more_behind + move.behind, -most, most);
    return {place.at, direction_angle(normal, side * place.tangent.cross(normal)) + move.turn_rad,
            ahead, behind - ahead};
}

Candidate nudged(const CourseRules& rules, const PlacedCourse& course, Draws& draws) {
    const double scale = std::pow(kNudgeRange, -draws.unit());
    const double steering = rules.tow.friction.share(scale * kNudgeSteering);
    CourseMove move{scale * kNudgeBands * rules.tow.width_mm * draws.normal(),
                    scale * kNudgeTurn_rad * draws.normal()};
    const double how = draws.unit();
    if (how > 0.5) {
        move.steering = steering * draws.normal();
        move.behind = how > 0.75 ? steering * draws.normal() : move.steering;
    }
    return moved_from_any(rules, course, move, draws);
}

Candidate moved_beside(const CourseRules& rules, const PlacedCourse& course, Draws& draws) {
    const bool turned = draws.unit() < 0.5;
    const double left = draws.either() * rules.tow.width_mm;
    return moved_from_any(
        rules, course, {left, turned ? kBesideTurn_rad * (2.0 * draws.unit() - 1.0) : 0.0}, draws);
}

}  // namespace meshwind
