/// Balances arrivals and departures at the rims, so that few continuous fibres lay the courses.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "winding/cover/select_courses.h"
#include "winding/plan/course.h"

namespace meshwind {

/// Directs the chosen courses and adds members, the cheapest chains first, until `fibres` fibres
/// lay them: at every node as many courses arrive as depart, but for the fibres' ends. Where the
/// library has no course that would help, courses are dropped; those then left form further fibres.
/// \param selection chosen members and layers; what is added is entered into both
[[nodiscard]] std::vector<DirectedCourse> balance_courses(std::span<const LibraryCourse> members,
                                                          std::span<const char> allowed,
                                                          std::size_t rims,
                                                          const SelectOptions& options, int fibres,
                                                          Selection& selection);

}  // namespace meshwind
