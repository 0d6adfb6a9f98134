/// Run time on a controller that slows down at corners by junction deviation, as GRBL does.
#pragma once

#include <cstddef>
#include <vector>

#include "machines/machine.h"
#include "postproc/motion/block.h"

namespace meshwind {

/// Settings of such a controller.
struct JunctionPlanner {
    /// > 0: distance of an imagined arc through a corner from it. GRBL's $11.
    double deviation_mm = 0.01;
    std::size_t blocks = 15;  ///< > 0: looked ahead over, the running one included; GRBL keeps 15
};

/// Seconds per block, 0 for the first. All axes count alike, in output units (mm and degrees), so
/// the speed along a block is that of all of them together. A block begins and ends with the speed
/// of its corners: at most
///     sqrt(a d s / (1 - s)),  s = sin(angle between the blocks / 2),
/// with the acceleration a that the axes allow along the bisector and the deviation d; such that
/// the program could stop within the look-ahead; and never above the block's own speed. Between
/// them it speeds up and slows down at the acceleration that the axes allow along it, without jerk.
/// Source: the planner of GRBL 1.1, `plan_buffer_line` and `planner_recalculate`; the corner's law
/// there is that of cornering on an arc. \pre machine has the axes of list
[[nodiscard]] std::vector<double> junction_times_s(const Machine& machine, const BlockList& list,
                                                   const JunctionPlanner& planner = {});

}  // namespace meshwind
