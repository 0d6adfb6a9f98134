/// Finds the centres of a tube's sections from its vertices, without knowing its line.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "mesh/mandrel.h"

namespace meshwind {

/// A section square to the line through the centres.
struct TubeSection {
    Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
    double radius_mm = 0.0;
};

/// From the mandrel's first rim to its second, evenly spaced by about `spacing_mm` along the line;
/// n >= 5; empty where no line is found. First guesses are the meeting points of the normals of
/// vertices about as far from both rims. Then about each place a centre and a radius that change
/// quadratically along the line are fitted to the vertices near it, the line is redrawn through the
/// centres, and this is repeated. \pre two rims, one piece
[[nodiscard]] std::vector<TubeSection> tube_sections(const Mandrel& mandrel, double spacing_mm);

}  // namespace meshwind
