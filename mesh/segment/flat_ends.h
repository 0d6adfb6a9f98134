/// Finds flat ends of legs, bounded by sharp edges, a round lip or the feet of tabs.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Per face the number of the flat end it belongs to, else -1. An end is a plane patch with a round
/// outline, from which the wall goes back all around and soon stands square to it; the tabs that
/// stand on it belong to it. Sharp edges bound no patch here: over a round lip, face and wall are
/// one smooth surface. Shoulders, on which the rest of the part stands, the bottoms of holes and
/// the flats of domes are no ends.
/// \param neighbours see face_neighbours \param normals unit, per face \param face_area mm^2
[[nodiscard]] std::vector<std::int32_t> flat_ends(
    const TriangleSoup& soup, const std::vector<std::array<std::int32_t, 3>>& neighbours,
    const std::vector<Eigen::Vector3d>& normals, const std::vector<double>& face_area);

}  // namespace meshwind
