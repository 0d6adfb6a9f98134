/// Finds ends that are no circles: fibre cannot turn round on a cylinder beyond them.
#pragma once

#include <string>

#include "mesh/mandrel.h"

namespace meshwind {

/// How far a rim may be off its circle, as a share of its radius, before the main job refuses it.
/// Ends that are cut where their legs end stay below 0.01; an oblique one reaches 0.05 when it is
/// 25 deg off square, 0.5 (1 / cos - 1).
inline constexpr double kMaxOffCircle = 0.05;

/// The rim that is farthest off its circle by that measure; null where all are round.
[[nodiscard]] const Rim* worst_off_circle(const Mandrel& mandrel);

[[nodiscard]] inline bool is_round(const Rim& rim) {
    return rim.circularity_mm <= kMaxOffCircle * rim.radius_mm;
}

/// Message: which rim, where, how far off, the possible cause and the remedy. \pre rim of the
/// mandrel
[[nodiscard]] std::string off_circle_words(const Mandrel& mandrel, const Rim& rim);

/// Message: place of the part's largest angular end, and the remedy. \pre there is one
[[nodiscard]] std::string angular_end_words(const Mandrel& mandrel);

}  // namespace meshwind
