/// Moves of a course from its place on the wall to another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/margins.h"
#include "core/random.h"
#include "winding/cover/library.h"
#include "winding/plan/course.h"

namespace meshwind {

/// How a course is moved: to its left, turned, and steered otherwise ahead of its seed and behind.
struct CourseMove {
    double left_mm = 0.0;
    double turn_rad = 0.0;
    double steering = 0.0;
    double behind = 0.0;
};

/// Steering of new courses as shares of the friction: geodesic, and three strengths to either side.
inline constexpr std::array<double, 7> kSteering = {
    0.0, 0.31, -0.31, 0.62, -0.62, margin::kCoverSteering, -margin::kCoverSteering};

/// Layers per sample that courses lay. \param samples their number
[[nodiscard]] std::vector<std::int32_t> layers_of(std::span<const PlacedCourse> courses,
                                                  std::size_t samples);

/// The station of a course's seed, where its two steerings meet.
[[nodiscard]] std::size_t seed_station(const PlacedCourse& course);

/// The candidate that a course becomes when it is moved from one of its stations; its steering
/// stays within margin::kCoverSteering of the friction. \param station any where `more_behind` is
/// 0, else seed_station()
[[nodiscard]] Candidate moved(const CourseRules& rules, const PlacedCourse& course,
                              std::size_t station, const CourseMove& move);

/// The candidate that a course becomes when it is moved and turned a little, and on half of the
/// draws steered otherwise: by a band, 0.1 rad and a tenth of the friction at the widest, by a
/// sixteenth of that at the narrowest.
[[nodiscard]] Candidate nudged(const CourseRules& rules, const PlacedCourse& course, Draws& draws);

/// The candidate beside a course, a band to either side, on half of the draws turned a little.
[[nodiscard]] Candidate moved_beside(const CourseRules& rules, const PlacedCourse& course,
                                     Draws& draws);

}  // namespace meshwind
