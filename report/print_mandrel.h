/// Prints a mandrel in words.
#pragma once

#include <ostream>

#include "report/inspection.h"

namespace meshwind {

/// Units, repairs, regions, rims, spindle axis and its other candidates, smooth fit, whether it is
/// a body of revolution or a tube, accuracy of paths and remarks; lengths in mm, positions in the
/// mandrel frame. For JSON see inspection_report.
void print_mandrel(std::ostream& out, const Inspection& found);

}  // namespace meshwind
