/// The moving steps of a joint path, with their ramps and corners for given durations.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "machines/machine.h"
#include "postproc/motion/joint_path.h"
#include "postproc/motion/time_law.h"

namespace meshwind {

/// Axes by fours, for vector instructions.
using AxisLanes = Eigen::Array4d;
inline constexpr std::size_t kAxisLanes = 4;

/// Rounding of sums against limits that are just kept.
inline constexpr double kStepSlack = 1e-9;

/// Index of the limit that sets a step's duration: the fibre, a corner, then three for each axis.
inline constexpr std::size_t kFibreLimit = 0;
inline constexpr std::size_t kCornerLimit = 1;
enum class AxisLimit : std::size_t { Velocity, Acceleration, Jerk };
[[nodiscard]] constexpr std::size_t limit_index(AxisLimit kind, std::size_t joint) {
    return 2 + 3 * joint + static_cast<std::size_t>(kind);
}

/// The ramps of the axes (axis_loads.h), by groups of lanes.
struct AxisRamps {
    bool limited_jerk = false;          ///< of any axis
    std::vector<AxisLanes> build_up_s;  ///< acceleration over jerk
};

/// Largest distance of the linear axes and the eye from a corner in ramps.
struct CornerLimit {
    double mm = std::numeric_limits<double>::infinity();
    std::vector<AxisLanes>
        linear_mm_s2;                  ///< a corner's cut over its ramp squared; 0 of rotary axes
    std::vector<AxisLanes> eye_mm_s2;  ///< of the eye, corners x groups x 3; none without a limit
};

/// The moving steps of a path, 1 .. count, and the limits of its axes; 0 and count + 1 are rest.
struct MovingSteps {
    std::size_t axes = 0;
    std::size_t groups = 0;  ///< of axes by fours
    std::size_t count = 0;
    std::vector<std::size_t> step;  ///< of the path
    /// Steps x groups, over acceleration: then differences of velocities are the times of ramps.
    std::vector<AxisLanes> move;
    std::vector<double> least_s;        ///< for velocities and fibre
    std::vector<std::size_t> least_of;  ///< which of them sets it
    AxisRamps ramps;
    CornerLimit corner;
};

/// \param fibre_mm per step, length that counts for the fibre's speed; the first is not used
/// \pre options.fibre_speed_mm_s > 0
[[nodiscard]] MovingSteps moving_steps(const Machine& machine, const JointPath& joints,
                                       std::span<const double> fibre_mm,
                                       const TimeLawOptions& options);

/// Change of velocity at the corner after step m, in s at full acceleration without jerk.
/// \param duration_s of each step, rest included
[[nodiscard]] inline AxisLanes velocity_change_s(const MovingSteps& steps,
                                                 std::span<const double> duration_s, std::size_t m,
                                                 std::size_t group) {
    return steps.move[(m + 1) * steps.groups + group] / duration_s[m + 1] -
           steps.move[m * steps.groups + group] / duration_s[m];
}

/// Ramps for changes of velocity, by the model of axis_loads.h, for all lanes.
/// \param jump_s size of velocity_change_s
[[nodiscard]] inline AxisLanes ramps_s(const AxisRamps& ramps, const AxisLanes& jump_s,
                                       std::size_t group) {
    if (!ramps.limited_jerk) {
        return jump_s;
    }
    const AxisLanes& build_up_s = ramps.build_up_s[group];
    return (jump_s >= build_up_s).select(jump_s + build_up_s, 2.0 * (jump_s * build_up_s).sqrt());
}

/// Ramps at the corner after step m.
[[nodiscard]] inline AxisLanes corner_ramps_s(const MovingSteps& steps,
                                              std::span<const double> duration_s, std::size_t m,
                                              std::size_t group) {
    const AxisLanes jump_s = velocity_change_s(steps, duration_s, m, group).abs();
    return ramps_s(steps.ramps, jump_s, group);
}

/// Offset of the linear axes and the eye at the corner after a step.
struct CornerOffset {
    double linear_mm2 = 0.0;
    std::array<double, 3> eye_mm{};

    [[nodiscard]] double mm2() const {
        return std::max(linear_mm2,
                        eye_mm[0] * eye_mm[0] + eye_mm[1] * eye_mm[1] + eye_mm[2] * eye_mm[2]);
    }
};

/// Adds what a group of axes contributes. \pre the corner is limited, and 0 < m < count
inline void add_offset(const MovingSteps& steps, std::size_t m, std::size_t group,
                       const AxisLanes& change_s, const AxisLanes& ramp_s, CornerOffset& offset) {
    const AxisLanes moment_s2 = change_s * ramp_s;
    offset.linear_mm2 += (steps.corner.linear_mm_s2[group] * moment_s2).square().sum();
    for (std::size_t k = 0; k < 3; ++k) {
        offset.eye_mm[k] +=
            (steps.corner.eye_mm_s2[(m * steps.groups + group) * 3 + k] * moment_s2).sum();
    }
}

/// The longest ramp of all axes at the corner after step m.
[[nodiscard]] double longest_ramp_s(const MovingSteps& steps, std::span<const double> duration_s,
                                    std::size_t m);

/// Half of both ramps of step m over its duration, for the worst axis. At most 1 where it has room.
[[nodiscard]] double room_ratio(const MovingSteps& steps, std::span<const double> duration_s,
                                std::size_t m);

/// Offset at the corner after step m over its limit; starting and stopping are no corners.
[[nodiscard]] double corner_ratio(const MovingSteps& steps, std::span<const double> duration_s,
                                  std::size_t m);

}  // namespace meshwind
