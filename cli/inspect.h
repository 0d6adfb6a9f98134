/// `meshwind inspect`: a mandrel in words.
#pragma once

#include <ostream>

#include "mesh/mandrel.h"

namespace meshwind {

/// Units, repairs, regions, rims, spindle axis, smooth fit and remarks; lengths in mm, positions in
/// the mandrel frame. For JSON see mandrel_report.
void print_mandrel(std::ostream& out, const Mandrel& mandrel);

}  // namespace meshwind
