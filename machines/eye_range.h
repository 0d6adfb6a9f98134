/// Bounds on the places that a machine's eye can reach.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "machines/machine.h"

namespace meshwind {

/// Mandrel frame, mm. The eye is never beyond; not every place within is reached.
struct EyeRange {
    double low_mm = -std::numeric_limits<double>::infinity();  ///< height along the spindle
    double high_mm = std::numeric_limits<double>::infinity();
    double nearest_mm = 0.0;  ///< distance from the spindle axis
    double farthest_mm = std::numeric_limits<double>::infinity();
    std::string along;   ///< letters of the axes that move the eye along the spindle; may be empty
    std::string across;  ///< letters of those that move it across
    /// Reading at the height 0 of an axis that alone moves the eye along the spindle, and its mm
    /// per mm of height, +-1 where it is parallel.
    double along_zero_mm = 0.0;
    double along_scale = 1.0;
};

/// Nothing for machines other than SpindleWristInverse's and ArmEyeInverse's class.
/// Accuracy: contains the eye for random joints within the limits (eye_range_test.cpp), for a robot
/// those at which its head is held as when it winds, up to 60 degrees from its side; the height,
/// and the distance where at most one axis moves the eye across, are the tightest such bounds. A
/// robot's reach is looked up on a grid and given one step of it, 80 mm, too large.
/// \param within_mm for a robot, the heights at which its eye can be no farther than this from the
/// spindle axis; if there are none, those at any distance
[[nodiscard]] std::optional<EyeRange> eye_range(
    const Machine& machine, double within_mm = std::numeric_limits<double>::infinity());

}  // namespace meshwind
