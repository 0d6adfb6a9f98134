/// A mandrel in words.
#pragma once

#include <ostream>

#include "geodesic/path_accuracy.h"
#include "mesh/mandrel.h"
#include "mesh/revolution/revolution.h"
#include "mesh/tube/tube.h"

namespace meshwind {

/// Units, repairs, regions, rims, spindle axis, smooth fit, whether it is a body of revolution
/// or a tube,
/// accuracy of paths and remarks; lengths in mm, positions in the mandrel frame. For JSON see
/// mandrel_report.
void print_mandrel(std::ostream& out, const Mandrel& mandrel, const PathAccuracy& accuracy,
                   const RevolutionFinding& revolution, const TubeFinding& tube);

}  // namespace meshwind
