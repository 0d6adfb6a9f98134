/// Messages about a part: its size and unit, in case the unit is wrong, and faults of its wall.
#pragma once

#include <string>
#include <vector>

#include "mesh/mandrel.h"

namespace meshwind {

/// "120.0 x 80.0 x 240.0 mm (unit mm, assumed)": extents along the axes of the file.
[[nodiscard]] std::string size_words(const Mandrel& mandrel);

/// Number of pieces, places of the two largest, and the key that takes the largest alone.
/// \pre two at least, largest first
[[nodiscard]] std::string pieces_words(const std::vector<WallPiece>& pieces);

/// Refuses a wall in pieces, and ends that are no circles if fibre turns on cylinders beyond them.
/// \throws InputError mesh.pieces, mesh.end_not_round, mesh.rim_not_round
void require_sound_wall(const Mandrel& mandrel, bool turns_on_extensions);

/// Message on places of the wall too sharp for the tow, and the key that fills them up; empty where
/// there are hardly any. \param sharp_mm2 area that a ball as wide as the tow cannot touch
[[nodiscard]] std::string sharp_words(const Mandrel& mandrel, double sharp_mm2,
                                      double tow_width_mm);

/// Adds a remark on places that a tow's width of putty would fill up, with the key that does so;
/// none where there are hardly any.
void propose_blend(const Mandrel& mandrel, double tow_width_mm, std::vector<std::string>& remarks);

/// Appendix to an error: whether the unit is right, where none was given, and the size.
[[nodiscard]] std::string unit_question(const Mandrel& mandrel);

}  // namespace meshwind
