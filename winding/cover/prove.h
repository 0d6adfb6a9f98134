/// The last word on a course before it enters a plan.
#pragma once

#include "winding/cover/placed_course.h"
#include "winding/plan/windability.h"

namespace meshwind {

/// Follows a course accurately, by every rule, and asks the machine to follow the course between
/// the halves of turns that lead to it and on from it; without one (null) a free length must be
/// found all along the course. On Rejection::None the course becomes what was found, its footprint
/// that of `rules`, windable in this direction alone; on others it is unchanged.
[[nodiscard]] Rejection prove_course(const CourseRules& rules, const Windability* machine,
                                     PlacedCourse& course);

}  // namespace meshwind
