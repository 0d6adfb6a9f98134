/// Thickness of a laid layer on each vertex of the surface.
#pragma once

#include <span>
#include <vector>

#include "mesh/mandrel.h"
#include "mesh/revolution/revolution.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// Width over which the bands of a pattern flow into each other where they end or pile up. It is
/// the knot distance of the cubic B-spline, two to either side, that spreads their fibre. One tow
/// width, but at least one and a half edges of the mesh, which could not show the slopes.
[[nodiscard]] double spread_mm(const Surface& surface, double tow_width_mm);

/// The same for courses that cross and end on each other in whole steps, which taut fibre spans:
/// two tow widths, but at least three edges of the mesh, whose fits carry no shorter waves.
[[nodiscard]] double crossing_spread_mm(const Surface& surface, double tow_width_mm);

/// Thickness on each vertex of a surface, mm, spread so that its standard deviation is that of the
/// spline, crossing spread / sqrt(3).
///
/// On any surface: from the layers per face, by two implicit steps of diffusion (finite elements,
/// lumped masses). The volume is kept. All of a rim gets one thickness and the slope there
/// vanishes: fibre that turns beyond it goes around it, and the extension that the next layer turns
/// on is a cylinder that the wall must meet without step and kink. Away from rims a wave of length
/// `2 pi / k` is left with `(1 + (k spread)^2 / 12)^-2` of its height. \param face_layers mean
/// layers per face of the surface \param tow_width_mm, thickness_mm > 0 \throws InputError
/// thicken.thin where triangles are too thin for that
[[nodiscard]] std::vector<double> build_up_mm(const Surface& surface,
                                              std::span<const double> face_layers,
                                              double tow_width_mm, double tow_thickness_mm);

/// Thickness on a body of revolution, the same all around: fibre length per arc length of the
/// meridian, spread by the spline itself. Where circuits lie evenly, as on a cylinder, the layer is
/// even to rounding. Fibre that would flow over the ends of the body stays at them.
[[nodiscard]] std::vector<double> regular_build_up_mm(const Surface& surface,
                                                      const BodyOfRevolution& body,
                                                      std::span<const Piece> pieces,
                                                      double tow_width_mm, double tow_thickness_mm);

}  // namespace meshwind
