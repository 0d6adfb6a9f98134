/// Putting chosen courses in order, so that as few continuous fibres as can be lay them all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "winding/plan/course.h"
#include "winding/turn/turn.h"

namespace meshwind {

/// An Eulerian trail through the nodes: a fibre that arrives circling an extension one way leaves
/// circling it the same way, and the dwell angles are kept small. Separate trails that share no
/// node are tried the other way round, if their courses allow it. \return every course once; the
/// last one has cut_after set; more cuts only where the ends of the courses leave no other way
[[nodiscard]] std::vector<OrderedCourse> order_courses(std::span<const Rim> rims,
                                                       std::span<const Member> members,
                                                       std::span<const LaidCourse> laid,
                                                       const TurnRule& rule);

}  // namespace meshwind
