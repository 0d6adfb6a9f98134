/// Putting chosen courses in order, so that one continuous fibre lays them all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "winding/library.h"
#include "winding/turn.h"

namespace meshwind {

/// One course in winding order.
struct OrderedCourse {
    std::int32_t member = -1;
    bool backward = false;   ///< wound from the member's end 1 to its end 0
    bool cut_after = false;  ///< the fibre ends here; the next course starts a new one
};

/// An Eulerian trail through the rims: a fibre that arrives turning one way leaves turning the same
/// way, courses that can be wound one way only are wound that way, and the dwell angles are kept
/// small. \param chosen members of the plan, each laid once (a member listed twice is laid twice)
/// \return every chosen course once; the last one has cut_after set; more cuts only where the ends
/// of the chosen courses leave no other way
[[nodiscard]] std::vector<OrderedCourse> order_courses(std::span<const Rim> rims,
                                                       std::span<const Member> members,
                                                       std::span<const std::int32_t> chosen,
                                                       const TurnRule& rule);

/// The end of `member` at which a course wound in this direction begins.
[[nodiscard]] inline const RimCrossing& start_of(const Member& member, bool backward) {
    return member.end[backward ? 1 : 0];
}
/// The end of `member` at which a course wound in this direction arrives.
[[nodiscard]] inline const RimCrossing& end_of(const Member& member, bool backward) {
    return member.end[backward ? 0 : 1];
}

}  // namespace meshwind
