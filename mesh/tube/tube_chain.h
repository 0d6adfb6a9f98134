/// Fits tubes whose line is made of straight stretches and arcs of circles.
#pragma once

#include <optional>
#include <span>

#include "mesh/tube/tube.h"

namespace meshwind {

/// Cuts a tube's line where its curvature jumps, takes each stretch for straight or for an arc, and
/// fits all of them together with the radius to the vertices by least squares (Levenberg and
/// Marquardt). The result has its parts, its line from rim to rim and its radius, one for the whole
/// tube where that of `tube` varies by less than kTubeResidualShare; residual and ends are not set.
/// \param rims two, in the order of the line \return none where cutting leaves no stretch
[[nodiscard]] std::optional<Tube> chain_tube(std::span<const Rim> rims, const Surface& surface,
                                             const Tube& tube);

}  // namespace meshwind
