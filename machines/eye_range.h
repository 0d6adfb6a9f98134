/// Where a machine's linear axes can bring the eye at all.
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
    std::string across;  ///< and of those that move it across
    /// What an axis that alone moves the eye along the spindle reads at the height 0, and its mm
    /// per mm of height, +-1 where it is parallel.
    double along_zero_mm = 0.0;
    double along_scale = 1.0;
};

/// Nothing for machines other than SpindleWristInverse's class.
/// Accuracy: holds every eye of random joints within the limits (eye_range_test.cpp); the height,
/// and the distance where at most one axis moves the eye across, are the least that do.
[[nodiscard]] std::optional<EyeRange> eye_range(const Machine& machine);

}  // namespace meshwind
