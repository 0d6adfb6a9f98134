/// Messages about a part that the axes do not bring the eye around.
#pragma once

#include <string>

#include "machines/eye_range.h"

namespace meshwind {

/// "axis Z needs -220.0 to 220.0 mm for the turns at the part's ends, has -150.0 to 150.0 mm".
/// \param low_mm, high_mm heights along the spindle; given as readings of the axis where it is one
[[nodiscard]] std::string along_words(const EyeRange& eye, double low_mm, double high_mm);

/// "there the eye needs to be 57.5 mm from the spindle axis; axis X brings it to 40.0 mm", or
/// nearest_words() where it can be as far away as that.
[[nodiscard]] std::string across_words(const EyeRange& eye, double needed_mm,
                                       double longest_fibre_mm);

/// "the eye comes no nearer to the spindle axis than 700.0 mm (axis X), and the longest free fibre
/// is 400.0 mm".
[[nodiscard]] std::string nearest_words(const EyeRange& eye, double longest_fibre_mm);

}  // namespace meshwind
