/// Fits the meridian through the vertices of a surface of revolution.
#pragma once

#include <vector>

#include "mesh/revolution/meridian.h"
#include "mesh/revolution/profile_points.h"

namespace meshwind {

/// Nodes of the meridian, from the first end to the second. Stretches within the scatter of the
/// vertices of a line become straight pieces by least squares, cylinders and discs exactly so; a
/// stretch that may as well be curved like its neighbours is not taken for straight. Between them
/// the nodes are the rings of vertices, or where vertices are not in rings, local polynomials of
/// degree four fitted to them. Two lines meet in a crease, a line and a curve without a kink where
/// the curve is parallel to the line.
///
/// Accuracy on meshes whose vertices lie on the surface: cylinders to rounding; rings as the spline
/// of mesh/revolution/meridian.h; scattered vertices of edge h on a curve of radius R about h^4 /
/// R^3 / 50; tests/mesh/revolution/revolution_test.cpp. \pre profile.why_not is empty
[[nodiscard]] std::vector<MeridianNode> fit_meridian(const ProfilePoints& profile);

}  // namespace meshwind
