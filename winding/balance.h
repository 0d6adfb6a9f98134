/// Making few continuous fibres possible: which way each course is wound, and what must be added.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "winding/library.h"
#include "winding/select.h"

namespace meshwind {

/// A course with the way it is wound.
struct LaidCourse {
    std::int32_t member = -1;
    bool backward = false;  ///< from the member's end 1 to its end 0
};

/// The end of `member` at which a course wound in this direction begins.
[[nodiscard]] inline const RimCrossing& start_of(const Member& member, bool backward) {
    return member.end[backward ? 1 : 0];
}
/// The end of `member` at which a course wound in this direction arrives.
[[nodiscard]] inline const RimCrossing& end_of(const Member& member, bool backward) {
    return member.end[backward ? 0 : 1];
}

/// A place where fibres are joined: a rim's extension, circled in one sense. A fibre that arrives
/// at a node leaves from the same node.
[[nodiscard]] inline std::size_t arrival_node(const RimCrossing& end) {
    return 2 * static_cast<std::size_t>(end.rim) + (end.sense > 0 ? 1U : 0U);
}
[[nodiscard]] inline std::size_t departure_node(const RimCrossing& start) {
    return 2 * static_cast<std::size_t>(start.rim) + (start.sense > 0 ? 0U : 1U);
}

/// Departure and arrival of a course wound in this direction.
using NodePair = std::pair<std::size_t, std::size_t>;
[[nodiscard]] inline NodePair nodes_of(const Member& member, bool backward) {
    return {departure_node(start_of(member, backward)), arrival_node(end_of(member, backward))};
}

/// Directs the chosen courses and adds members, the cheapest chains first, until so many fibres lay
/// them: at every node as many courses arrive as depart, but for the fibres' ends. Where the
/// library has no course that would help, courses are dropped; what is then left are further
/// fibres. \param selection chosen members and layers; what is added is entered into both
[[nodiscard]] std::vector<LaidCourse> balance_courses(std::span<const Member> members,
                                                      std::span<const char> allowed,
                                                      std::size_t rims,
                                                      const SelectOptions& options, int fibres,
                                                      Selection& selection);

}  // namespace meshwind
