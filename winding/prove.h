/// The last word on a course before it enters a plan.
#pragma once

#include <functional>

#include "winding/placed_course.h"
#include "winding/plan.h"

namespace meshwind {

/// What a machine says of a piece, in the direction in which it would be wound: None where it winds
/// it. Pure and thread-safe.
using AskMachine = std::function<Rejection(const Piece&)>;

/// Follows a course accurately, by every rule, and asks the machine; without one a free length must
/// be found all along. On Rejection::None the course becomes what was found, its footprint that of
/// `rules`, windable in this direction alone; on others it is unchanged.
[[nodiscard]] Rejection prove_course(const CourseRules& rules, const AskMachine& machine,
                                     PlacedCourse& course);

}  // namespace meshwind
