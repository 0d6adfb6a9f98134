/// Time law: the duration of each step of a joint path under the limits of the axes and of the
/// fibre.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "machines/machine.h"
#include "postproc/eye/eye_path.h"
#include "postproc/motion/axis_loads.h"
#include "postproc/motion/binding_limits.h"
#include "postproc/motion/joint_path.h"

namespace meshwind {

struct TimeLawOptions {
    double fibre_speed_mm_s = 500.0;  ///< > 0 (30 m/min); the machine's max_speed holds besides
    /// > 0: largest distance of the linear axes, and of the eye against the mandrel, from a corner
    /// in ramps (axis_loads.h). The controller's setting, Dialect::corner_tolerance_mm.
    double corner_mm = std::numeric_limits<double>::infinity();
    double tick_s = 0.0;  ///< durations are whole ticks; 0: any
};

/// A joint path with time. Step i leads from point i - 1 to point i; step 0 takes no time.
struct TimedPath {
    std::vector<double> step_s;         ///< n durations, the first 0; 0 as well where nothing moves
    double ramp_s = 0.0;                ///< added for starting from rest and stopping
    double duration_s = 0.0;            ///< the sum of all these
    std::vector<BindingLimit> binding;  ///< longest first; only limits that bind somewhere
};

/// Durations, short in sum, with
///  - |dq| <= velocity * T for every axis,
///  - fibre_mm <= fibre speed * T,
///  - axis_loads: acceleration ratio at most 1, corners cut by at most `corner_mm`.
/// Each constraint ties together the durations of three neighbouring steps, so the best choice out
/// of a few durations a step is found exactly, by dynamic programming along the path. First every
/// step that has no room for its ramps is slowed down, with its neighbours; then all steps may
/// become a share shorter or longer at once, and that share shrinks to a thousandth. It is not
/// proven that no shorter times exist; on random paths they are within 1 % of the best out of a
/// fine grid (time_law_test). The time is linear in the number of steps.
/// \param fibre_mm per step, length that counts for the fibre's speed; the first is not used
/// \pre fibre_mm has an entry for each point of joints
/// \throws InputError time.fibre_speed when the fibre speed is not positive
[[nodiscard]] TimedPath time_path(const Machine& machine, std::span<const double> fibre_mm,
                                  const JointPath& joints, const TimeLawOptions& options = {});

}  // namespace meshwind
