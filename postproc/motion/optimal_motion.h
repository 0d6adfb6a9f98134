/// Time-optimal motion along a path: chooses free length and turn of the mandrel together, which
/// the path leaves free.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "machines/machine.h"
#include "mesh/ray_query.h"
#include "postproc/eye/eye_path.h"
#include "winding/plan/free_fibre.h"

namespace meshwind {

/// Fibre between two knots, at which turn and length are chosen: 24 ms at 30 m/min, in which an
/// axis of 2.5 m/s^2 moves by less than 1 mm to either side.
inline constexpr double kKnot_mm = 12.0;

struct OptimalMotionTask {
    const Machine& machine;
    const RayQuery& obstacles;
    const EyePath& path;               ///< its stations stay; a motion that works, with its turns
    std::span<const double> ahead_mm;  ///< per station: how far ahead the free fibre begins
    const FreeFibreRule& rule;
    std::span<const double> more_mm;  ///< per station: clearance on top of the rule's
    std::span<const char> free{};     ///< per station: 0 keeps the path's motion; empty: all free
    double fibre_speed_mm_s = 500.0;  ///< > 0
    double knot_mm = kKnot_mm;   ///< fibre between two places at which turn and length are chosen
    bool from_given = false;     ///< only mend the path's motion and smooth it
    bool fixed_lengths = false;  ///< the path's lengths stay; only the turns are chosen
};

/// Free lengths and turns of the mandrel with which the fibre can run as near to its speed as the
/// axes let it. First a dynamic programme over a grid of turns, counted from the central angle, and
/// lengths, at places some kKnot_mm apart: the way of least total time through the clear choices. A
/// step takes as long as the slowest of the fibre, the axes' velocities and, at each place, their
/// accelerations if turn and length stayed as they are. Then all turns and lengths are moved at
/// once to reduce the time further (Gauss-Newton on the axes' true accelerations), each within the
/// clear range around it. Between the places both are cubic splines.
///
/// \return the path with these lengths, eyes and turns. The times are estimates, and clearance is
/// looked up in a table: the result is to be checked as any motion is. It depends on nothing but
/// the task. Source: docs/post.md; fu_2009_post_processing names turns and lengths that were chosen
/// by hand.
/// \throws InputError machine.missing_axis, machine.unsupported_chain
[[nodiscard]] EyePath optimal_motion(const OptimalMotionTask& task);

}  // namespace meshwind
