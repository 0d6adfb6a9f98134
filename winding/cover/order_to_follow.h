/// Orders courses so that the machine can follow the turns between them.
#pragma once

#include <span>
#include <vector>

#include "winding/cover/library.h"
#include "winding/cover/order_courses.h"
#include "winding/plan/course.h"
#include "winding/plan/windability.h"

namespace meshwind {

struct FollowedOrder {
    std::vector<OrderedCourse> courses;
    int turns_refused = 0;  ///< turns left in the order although the machine cannot follow them
    ClosedTurns closed{};   ///< all turns that it was found not to follow
};

/// Orders and arranges courses (order_courses.h, arrange_courses.h). Where the machine cannot
/// follow a turn from one course to the next, other orders are tried. The one with the fewest cuts
/// is taken, and then the one with the fewest such turns. As far as more fibres are allowed, they
/// are cut at the turns that are left. \param machine null: each turn can be followed
/// \param members proven \param lateness per entry of `laid` \param fibres that may be tied on, >=
/// 1
[[nodiscard]] FollowedOrder order_to_follow(const CourseRules& rules, const Windability* machine,
                                            std::span<const LibraryCourse> members,
                                            std::span<const DirectedCourse> laid,
                                            std::span<const double> lateness, std::size_t fibres);

/// Whether the machine can follow a turn from some other course to a proven one, and from it to
/// some other. True where fewer than three others may be turned to: the course may be a fibre's
/// end. Thread-safe. \param machine null: each turn can be followed \param others proven; the
/// course may be among them
[[nodiscard]] bool can_be_turned(const CourseRules& rules, const Windability* machine,
                                 const PlacedCourse& course, std::span<const PlacedCourse> others);

}  // namespace meshwind
