/// The part's size and unit in words, for a summary and for those who took one unit for another.
#pragma once

#include <string>

#include "mesh/mandrel.h"

namespace meshwind {

/// "120.0 x 80.0 x 240.0 mm (unit mm, assumed)": extents along the axes of the file.
[[nodiscard]] std::string size_words(const Mandrel& mandrel);

/// What a tow's width of putty would fill up, and the key that does so; empty where hardly
/// anything.
[[nodiscard]] std::string blend_proposal(const Mandrel& mandrel, double tow_width_mm);

/// Behind an error: whether the unit is right, where nobody has given it, and the size.
[[nodiscard]] std::string unit_question(const Mandrel& mandrel);

}  // namespace meshwind
