/// Rearranges the courses of a fibre: junctions early, hoops late.
#pragma once

#include <span>
#include <vector>

#include "mesh/rim.h"
#include "winding/cover/order_courses.h"
#include "winding/plan/course.h"
#include "winding/turn/course_turns.h"

namespace meshwind {

/// Brings courses over junctions forward and hoops back, so that hoops clamp the fibre under them.
/// Stretches of a fibre that begin and end at one node change places, as long as the gain is worth
/// the fibre in turns: a course that comes later by the whole plan for being hoop instead of
/// junction is worth six rounds of the rim. Each fibre keeps its courses. \param lateness per entry
/// of the order \param closed turns that are not taken where the fibre has another way
void arrange(std::span<const Rim> rims, std::span<const LibraryCourse> members,
             const CourseTurns& turns, std::span<const double> lateness,
             std::vector<OrderedCourse>& order, const ClosedTurns& closed = {});

}  // namespace meshwind
