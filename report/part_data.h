/// Data of the page of `inspect --page`, in one binary text.
#pragma once

#include <string>

#include "report/inspection.h"

namespace meshwind {

/// A part for its page (viewer/src/part/data.ts reads it), as page_arrays.h lays it out. The header
/// has "inspection" (inspection_report), "text" (print_inspection), "refused" (in words, or null),
/// "tow_width_mm", and "details_mm", by which details stand out of the wall. Arrays, positions in
/// the mandrel's frame, mm:
///
///     part/points, part/faces   every triangle of the part: the winding surface and all others
///     part/region               per triangle: id of its region
///     part/sharp                per triangle: 1 where a ball as wide as the tow cannot touch it
///     details/points, .../faces details removed from the wall
///     rimN/loop                 the vertices of rim N in their order
[[nodiscard]] std::string part_data(const Inspection& found);

}  // namespace meshwind
