/// The part's size and unit in words, for a summary and for those who took one unit for another.
#pragma once

#include <string>
#include <vector>

#include "mesh/mandrel.h"

namespace meshwind {

/// "120.0 x 80.0 x 240.0 mm (unit mm, assumed)": extents along the axes of the file.
[[nodiscard]] std::string size_words(const Mandrel& mandrel);

/// How many pieces, where the two largest are, and the key that takes the largest alone.
/// \pre two at least, largest first
[[nodiscard]] std::string pieces_words(const std::vector<WallPiece>& pieces);

/// Adds what a tow's width of putty would fill up, and the key that does so; nothing where hardly
/// anything is.
void propose_blend(const Mandrel& mandrel, double tow_width_mm, std::vector<std::string>& remarks);

/// Behind an error: whether the unit is right, where nobody has given it, and the size.
[[nodiscard]] std::string unit_question(const Mandrel& mandrel);

}  // namespace meshwind
