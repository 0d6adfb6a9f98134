/// A course in its place on the wall, and how it is moved to another.
#pragma once

#include <cstddef>

#include "winding/library.h"

namespace meshwind {

/// A course in its place, with the way it is wound.
struct PlacedCourse {
    Member member;
    SurfacePath path;  ///< from end 0 to end 1
    bool backward = false;
    bool wound = false;  ///< its own program lays it as planned
    /// Which of the courses that lead from stage to stage (fibre_routes.h) it is: such a one stays
    /// as it is. -1 for all others.
    std::int32_t link = -1;
};

/// How a course is moved: to its left, turned, and steered otherwise ahead of its seed and behind.
struct CourseMove {
    double left_mm = 0.0;
    double turn_rad = 0.0;
    double steering = 0.0;
    double behind = 0.0;
};

/// Steering of new courses as shares of the friction: geodesic, and three strengths to either side.
/// The strongest leaves room for the error of measuring slip on the mesh.
inline constexpr std::array<double, 7> kSteering = {0.0, 0.31, -0.31, 0.62, -0.62, 0.92, -0.92};
inline constexpr double kMostSteering = 0.92;

/// The station of a course's seed, where its two steerings meet.
[[nodiscard]] std::size_t seed_station(const PlacedCourse& course);

/// The candidate that a course becomes when it is moved from one of its stations; its steering
/// stays within kMostSteering of the friction. \param station any where `more_behind` is 0, else
/// seed_station()
[[nodiscard]] Candidate moved(const CourseRules& rules, const PlacedCourse& course,
                              std::size_t station, const CourseMove& move);

}  // namespace meshwind
