/// How long each step of a joint path takes under the limits of the axes and of the fibre.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "machines/machine.h"
#include "postproc/eye_path.h"
#include "postproc/joint_path.h"

namespace meshwind {

struct TimeLawOptions {
    double fibre_speed_mm_s = 500.0;  ///< > 0 (30 m/min); the machine's max_speed holds besides
    /// Sweeps over the path that slow steps down for the accelerations, at most: they end when
    /// nothing changes any more; 0 leaves the accelerations aside.
    int acceleration_sweeps = 2000;
    double tick_s = 0.0;  ///< durations are whole ticks; 0: any
};

/// What set the duration of a step.
struct BindingLimit {
    std::string name;     ///< "fibre", "C velocity", "C acceleration" ...
    double time_s = 0.0;  ///< total duration of the steps that it set
};

/// A joint path with time. Step i leads from point i - 1 to point i; step 0 takes no time.
struct TimedPath {
    std::vector<double> step_s;         ///< n durations, the first 0; 0 as well where nothing moves
    double ramp_s = 0.0;                ///< what starting from rest and stopping add
    double duration_s = 0.0;            ///< the sum of all these
    std::vector<BindingLimit> binding;  ///< longest first; only limits that bind somewhere
    /// Largest ramp of an axis between neighbouring steps over the time that it has; <= 1 when the
    /// sweeps sufficed.
    double worst_acceleration_ratio = 0.0;
};

/// Shortest durations with
///  - |dq| <= velocity * T for every axis,
///  - fibre_mm <= fibre speed * T,
///  - room for the ramps. Within a step all axes run evenly; about the point between two steps of
///    velocities v1 and v2 a controller ramps from one to the other in |v2 - v1| / acceleration.
///    The ramp may take half of each step, so that ramps never overlap, but of the longer step no
///    more than the shorter lasts: |v2 - v1| <= acceleration * min((T1 + T2)/2, 3/2 T1, 3/2 T2).
///    Centred on the point it would take in sum no longer than a jump; so it is off by no more than
///    |v2 - v1| * min(T1, T2) / 4. In a reversal each side brakes or starts on its own, and from
///    rest to rest so do the start and the stop: |v| <= acceleration * T/2. The ramps from and to
///    rest have nothing on the other side to make up for them and add |v| / (2 acceleration) each:
///    `ramp_s`;
/// the last by forward and backward sweeps that only lengthen, so the result is safe but not proven
/// shortest. \param fibre_mm per step, what the fibre's speed counts; the first is not used
/// \pre fibre_mm has an entry for each point of joints
/// \throws InputError time.fibre_speed when the fibre speed is not positive
[[nodiscard]] TimedPath time_path(const Machine& machine, std::span<const double> fibre_mm,
                                  const JointPath& joints, const TimeLawOptions& options = {});

/// What the fibre's speed counts at each point of a path, in mm: max(|ds|, |ds + dL|), fibre laid,
/// and drawn through the eye, evenly from the point before; 0 for the first.
[[nodiscard]] std::vector<double> fibre_moved_mm(const EyePath& path);

/// Where a limit of an axis is used most.
struct AxisLoad {
    double ratio = 0.0;  ///< needed over allowed; above 1 the limit is broken
    std::size_t step = 0;
    std::size_t joint = 0;
};

struct AxisLoads {
    AxisLoad velocity;
    AxisLoad acceleration;  ///< ramps over the room that they have, as above
};

/// What given durations ask of the axes. \param step_s per step, the first is not used
[[nodiscard]] AxisLoads axis_loads(const Machine& machine, const JointPath& joints,
                                   std::span<const double> step_s);

}  // namespace meshwind
