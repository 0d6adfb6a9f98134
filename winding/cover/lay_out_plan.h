/// Lays out ordered courses and their turns as the pieces of a plan.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "winding/cover/library.h"
#include "winding/cover/order_courses.h"
#include "winding/plan/plan.h"
#include "winding/plan/windability.h"

namespace meshwind {

/// A finished course as it is wound.
[[nodiscard]] Piece piece_of(const CourseRules& rules, TracedCourse&& course,
                             const LibraryCourse& member, bool backward);

/// The same of a proven member, followed again.
[[nodiscard]] Piece piece_of(const CourseRules& rules, const LibraryCourse& member, bool backward);

/// Lays out courses and the turns between them: the plan's pieces, fibres, turns and worst figures.
/// \param members proven ones \param order of some of them
void lay_out(const CourseRules& rules, std::span<const LibraryCourse> members,
             std::span<const OrderedCourse> order, Plan& plan);

/// Puts a course between the half of a turn that leads to it and the half that leads on.
/// \param pieces the course of `member`
void add_half_turns(const CourseRules& rules, const LibraryCourse& member, bool backward,
                    std::vector<Piece>& pieces);

/// Courses of a plan that a trial refuses: by their place behind the library's members, in order,
/// each once. For a refused turn it is the course at which more turns are closed.
/// \param order from which the plan was laid out \param closed turns between those courses
[[nodiscard]] std::vector<std::pair<std::size_t, CourseFault>> refused_courses(
    const TrialWinding& trial, const Plan& plan, std::span<const OrderedCourse> order,
    const ClosedTurns& closed, std::size_t library_size);

}  // namespace meshwind
