/// Finds the tube under layers, which are thicker inside a bend than outside.
#pragma once

#include "mesh/mandrel.h"
#include "mesh/tube/tube.h"

namespace meshwind {

/// The bare mandrel's tube after layers were laid: line, parts and frame are those of the bare one,
/// since fits to the grown wall would follow the thicker side; the radius is the mean over its
/// vertices, and `residual_mm` the largest distance of one from that. Rims and their lean are those
/// of the grown mandrel, in the order of the line.
/// \param most_mm largest thickness on the bare tube. Walls that are anywhere further in than the
/// bare tube or further out than that, by more than the limits of a tube (mesh/tube/tube.h), are
/// refused, and so are bare tubes whose radius varies
[[nodiscard]] TubeFinding grown_tube(const Tube& bare, const Mandrel& grown, double most_mm);

}  // namespace meshwind
