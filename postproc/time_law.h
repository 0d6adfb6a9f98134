/// How long each step of a joint path takes under the limits of the axes and of the fibre.
#pragma once

#include <string>
#include <vector>

#include "machines/machine.h"
#include "postproc/eye_path.h"
#include "postproc/joint_path.h"

namespace meshwind {

struct TimeLawOptions {
    double fibre_speed_mm_s = 500.0;  ///< > 0 (30 m/min); the machine's max_speed holds besides
    /// Sweeps over the path that slow steps down for the accelerations. Each sweep makes a
    /// slow-down felt all along the path, so few are needed; 0 leaves the accelerations aside.
    int acceleration_sweeps = 20;
};

/// What set the duration of a step.
struct BindingLimit {
    std::string name;     ///< "fibre", "C velocity", "C acceleration" ...
    double time_s = 0.0;  ///< total duration of the steps that it set
};

/// A joint path with time. Step i leads from point i - 1 to point i; step 0 takes no time.
struct TimedPath {
    std::vector<double> step_s;         ///< n durations, the first 0; 0 as well where nothing moves
    double duration_s = 0.0;            ///< their sum
    std::vector<BindingLimit> binding;  ///< longest first; only limits that bind somewhere
    /// Largest change of an axis' velocity between neighbouring steps over what its acceleration
    /// allows in the time between their middles; <= 1 when the sweeps sufficed.
    double worst_acceleration_ratio = 0.0;
};

/// Shortest durations with
///  - |dq| <= velocity * T for every axis,
///  - fibre laid and fibre through the eye, max(|ds|, |ds + dL|) <= fibre speed * T,
///  - |dq2/T2 - dq1/T1| <= acceleration * (T1 + T2)/2 between neighbours, from rest to rest,
/// the last by forward and backward sweeps that only lengthen, so the result is safe but not proven
/// shortest. \pre path and joints have equal length
/// \throws InputError time.fibre_speed when the fibre speed is not positive
[[nodiscard]] TimedPath time_path(const Machine& machine, const EyePath& path,
                                  const JointPath& joints, const TimeLawOptions& options = {});

/// Longest fibre that the tensioner must take back: the largest fall of s + L behind its running
/// maximum, in mm; compare with FibreLimits::take_up_mm.
[[nodiscard]] double largest_take_back_mm(const EyePath& path);

}  // namespace meshwind
