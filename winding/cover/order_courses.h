/// Orders courses so that as few continuous fibres as possible lay them all.
#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "winding/plan/course.h"
#include "winding/turn/course_turns.h"

namespace meshwind {

/// Turns that the machine cannot follow, each from one course to another.
using ClosedTurns = std::set<std::pair<DirectedCourse, DirectedCourse>>;

/// Cost of one course following another: the fibre of the turn as an angle about the rim, rad, and
/// for a closed turn more than all of any plan. Worked out once for each pair.
class TurnCosts {
public:
    /// All arguments are kept by reference, and must not change.
    TurnCosts(std::span<const Rim> rims, std::span<const LibraryCourse> members,
              const CourseTurns& turns, const ClosedTurns& closed)
        : rims_(rims),
          members_(members),
          turns_(turns),
          closed_(closed),
          row_(2 * members.size()) {}

    [[nodiscard]] double rad(const DirectedCourse& from, const DirectedCourse& to);

private:
    [[nodiscard]] double work_out_rad(const DirectedCourse& from, const DirectedCourse& to) const;

    std::span<const Rim> rims_;
    std::span<const LibraryCourse> members_;
    const CourseTurns& turns_;
    const ClosedTurns& closed_;
    std::vector<std::size_t> row_;  // from 1, per member and way; 0 where nothing was asked for it
    std::vector<std::vector<double>> known_;  // by rows; not a number where it was not asked for
};

/// An Eulerian trail through the nodes: a fibre that arrives circling an extension one way leaves
/// circling it the same way, and the fibre of the turns is kept short. Separate trails that share
/// no node are tried the other way round, if their courses allow it. Closed turns are taken only
/// where the fibre has no other way. \return every course once; the last one has cut_after set;
/// more cuts only where the ends of the courses leave no other way
[[nodiscard]] std::vector<OrderedCourse> order_courses(std::span<const Rim> rims,
                                                       std::span<const LibraryCourse> members,
                                                       std::span<const DirectedCourse> laid,
                                                       const CourseTurns& turns,
                                                       const ClosedTurns& closed = {});

}  // namespace meshwind
