/// How thick a layer is once it is laid.
#pragma once

#include <span>
#include <vector>

#include "mesh/mandrel.h"
#include "mesh/revolution.h"
#include "winding/plan.h"

namespace meshwind {

/// What lies on each vertex of a surface, mm. Bands flow into each other where they end or pile up,
/// as if their fibre were spread with a standard deviation of tow width / sqrt(3): that of a cubic
/// B-spline of two tow widths to either side.
///
/// On any surface: from the layers per face, spread by two implicit steps of diffusion (finite
/// elements, lumped masses). The volume is kept. Edges longer than the tow leave it as it is.
/// \param face_layers mean layers per face of the surface \param tow_width_mm, thickness_mm > 0
[[nodiscard]] std::vector<double> build_up_mm(const Surface& surface,
                                              std::span<const double> face_layers,
                                              double tow_width_mm, double tow_thickness_mm);

/// On a body of revolution the same all around: fibre length per arc length of the meridian, spread
/// by the spline itself. Where circuits lie evenly, as on a cylinder, the layer is even to
/// rounding; the volume of fibre is kept to the spread beyond the body's ends.
[[nodiscard]] std::vector<double> regular_build_up_mm(const Surface& surface,
                                                      const BodyOfRevolution& body,
                                                      std::span<const Piece> pieces,
                                                      double tow_width_mm, double tow_thickness_mm);

}  // namespace meshwind
