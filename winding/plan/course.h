/// Courses, one type for each state: candidate, sketch, member of the library, followed, placed on
/// the wall, laid one way or the other, in winding order.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "geodesic/surface_path.h"
#include "winding/plan/turns.h"

namespace meshwind {

/// A path by its parameters: traced both ways from a seed until it meets a rim.
struct Candidate {
    SurfacePoint seed;
    double angle_rad =
        0.0;  ///< direction in the tangent plane, from a fixed but arbitrary reference
    double slip_ratio = 0.0;   ///< steering where the surface is convex along the path
    double more_behind = 0.0;  ///< added to slip_ratio from the seed back to end 0
};

/// An admissible course: from end 0 to end 1, each over a rim.
struct LibraryCourse {
    Candidate candidate;
    std::array<RimCrossing, 2> end;
    bool windable_forward = false;  ///< from end 0 to end 1
    bool windable_backward = false;
    double length_mm = 0.0;
    double turn_mm = 0.0;                 ///< fibre of the half turns at both ends
    double off_angle_mm = 0.0;            ///< length off the wanted winding angle (wound_angle.h)
    std::vector<std::int32_t> footprint;  ///< coverage samples
};

/// True when it is windable in at least one direction.
[[nodiscard]] inline bool is_windable(const LibraryCourse& member) {
    return member.windable_forward || member.windable_backward;
}

/// A candidate traced by the walk over the facets: a first estimate, many times as fast as judge().
struct DraftCourse {
    LibraryCourse course;  ///< windable neither way until that is checked
    SurfacePath path;      ///< from end 0 to end 1
};

/// A finished course, from end 0 to end 1.
struct TracedCourse {
    SurfacePath path;
    TautString string;
    SlipMeasure slip;
};

/// A course in its place, with the way it is wound.
struct PlacedCourse {
    LibraryCourse member;
    SurfacePath path;  ///< from end 0 to end 1
    bool backward = false;
    bool wound = false;  ///< its own program lays it as planned
    /// Its number among the courses that lead from stage to stage (fibre_routes.h), which are not
    /// moved. -1 for all others.
    std::int32_t link = -1;
    std::int32_t of_library = -1;  ///< its member of the library; -1: it was moved
};

/// A course with the way it is wound.
struct DirectedCourse {
    std::int32_t member = -1;
    bool backward = false;  ///< from the member's end 1 to its end 0

    auto operator<=>(const DirectedCourse&) const = default;
};

/// The end of `member` at which a course wound in this direction begins.
[[nodiscard]] inline const RimCrossing& start_of(const LibraryCourse& member, bool backward) {
    return member.end[backward ? 1 : 0];
}
/// The end of `member` at which a course wound in this direction arrives.
[[nodiscard]] inline const RimCrossing& end_of(const LibraryCourse& member, bool backward) {
    return member.end[backward ? 0 : 1];
}

/// A node is a rim's extension, circled in one sense; fibres are joined there. A fibre that arrives
/// at a node leaves from the same node.
[[nodiscard]] inline std::size_t arrival_node(const RimCrossing& end) {
    return 2 * static_cast<std::size_t>(end.rim) + (end.sense > 0 ? 1U : 0U);
}
[[nodiscard]] inline std::size_t departure_node(const RimCrossing& start) {
    return 2 * static_cast<std::size_t>(start.rim) + (start.sense > 0 ? 0U : 1U);
}

/// Departure and arrival of a course wound in this direction.
using NodePair = std::pair<std::size_t, std::size_t>;
[[nodiscard]] inline NodePair nodes_of(const LibraryCourse& member, bool backward) {
    return {departure_node(start_of(member, backward)), arrival_node(end_of(member, backward))};
}

/// One course in winding order.
struct OrderedCourse {
    DirectedCourse course;
    bool cut_after = false;  ///< the fibre ends here; the next course starts a new one
};

}  // namespace meshwind
