/// The last word on a course before it enters a plan.
#pragma once

#include <functional>
#include <span>

#include "winding/placed_course.h"
#include "winding/plan.h"

namespace meshwind {

/// What a machine says of pieces, in the order and direction in which it would wind them: None
/// where it winds them. Pure and thread-safe.
using AskMachine = std::function<Rejection(std::span<const Piece>)>;

/// Follows a course accurately, by every rule, and asks the machine, for the course between the
/// halves of turns that lead to it and on from it; without one a free length must be found all
/// along the course. On Rejection::None the course becomes what was found, its footprint that of
/// `rules`, windable in this direction alone; on others it is unchanged.
[[nodiscard]] Rejection prove_course(const CourseRules& rules, const AskMachine& machine,
                                     PlacedCourse& course);

}  // namespace meshwind
