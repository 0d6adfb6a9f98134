/// Velocity and acceleration of the axes for given durations: the one model of how a controller
/// runs the blocks.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "machines/machine.h"
#include "postproc/motion/joint_path.h"

namespace meshwind {

/// Time in which an axis changes its velocity by `change` (axis units/s, sign free): at full
/// acceleration, which builds up and fades at the axis' jerk where that is limited. v/a without
/// jerk; v/a + a/j, or 2 sqrt(v/j) where the acceleration is not reached.
[[nodiscard]] double ramp_s(const Axis& axis, double change);

/// Largest use of a limit of an axis.
struct AxisLoad {
    double ratio = 0.0;  ///< needed over allowed; above 1 the limit is broken
    std::size_t step = 0;
    std::size_t joint = 0;
};

/// Distance by which ramps cut the corner after a step.
struct CornerCut {
    double mm = 0.0;
    std::size_t step = 0;
};

struct AxisLoads {
    AxisLoad velocity;
    AxisLoad acceleration;  ///< duration of ramps over the room that they have
    CornerCut linear;       ///< the worst of the linear axes, together as a vector
    CornerCut eye;          ///< the worst of the eye against the mandrel, all axes taken together
};

/// The model. Within a step every axis runs evenly, straight from point to point. About the point
/// between two steps it ramps from one velocity to the other, in ramp_s, half before and half
/// after. So a ramp covers in sum the same distance as the corner, and off its ramps the axis is
/// exactly on the program: nothing adds up, whatever the durations. Such a motion exists when no
/// two ramps of an axis overlap, that is when in each step half the ramp before and half the ramp
/// after together last no longer than the step: their ratio is `acceleration`. The start from rest
/// and the stop are ramps as well: one begins half a ramp early, the other ends half a ramp late.
///
/// At the corner the axis is off by a moment of half its ramp: |v2 - v1| * ramp / 8 without jerk,
/// less with it. That is the largest distance. A controller that blends corners of the linear axes
/// within it runs the program in its time; one that is told to stay nearer has to slow down. All
/// axes together move the eye against the mandrel (eye_moves, first order).
/// \param step_s per step, the first is not used; steps of 0 s are passed over
[[nodiscard]] AxisLoads axis_loads(const Machine& machine, const JointPath& joints,
                                   std::span<const double> step_s);

}  // namespace meshwind
