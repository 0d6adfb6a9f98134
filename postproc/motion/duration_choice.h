/// Shortens the durations of all steps by dynamic programming along the path, out of a few for
/// each.
#pragma once

#include <vector>

#include "postproc/motion/moving_steps.h"

namespace meshwind {

/// Least share by which steps are tried shorter or longer.
inline constexpr double kMinDurationShare = 0.001;

/// All steps may become a share shorter or longer at once, and that share shrinks to
/// kMinDurationShare. The sum never gets longer, for each step may keep its duration.
/// \param duration_s of each step, rest included; ramps have room and corners are within the limit
/// A cancellation point in each round.
[[nodiscard]] std::vector<double> tightened_s(const MovingSteps& steps,
                                              std::vector<double> duration_s);

}  // namespace meshwind
