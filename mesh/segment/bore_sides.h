/// Parts the wall of a part from its bore where they run into each other.
/// Included by .cpp files of this folder only.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "mesh/segment/end_caps.h"
#include "mesh/segment/segment.h"
#include "mesh/visibility.h"

namespace meshwind {

/// A point sees the outside when most directions escape. The wall of a long bore never does: even
/// at its very mouth half of the directions meet the opposite wall.
inline constexpr double kMaxDirections = 0.5;

/// Share of its area from which a blind region may see.
inline constexpr double kBlindShare = 0.05;

/// Groups of regions that are connected without crossing an end cap or a bore.
[[nodiscard]] std::vector<std::vector<std::int32_t>> pieces_of(
    const std::vector<Region>& regions, const std::vector<RegionFacts>& facts);

/// Where an end face is notched or its lip rounded, wall and bore run into each other: such pieces
/// touch one end cap from both sides, or a region of theirs sees the outside in one place and
/// nothing in another. They are parted halfway between the two. Returns per face 1 where it is on
/// the bore's side; empty when no pieces run together. \param normals unit, per face \param
/// face_area mm^2, per face
[[nodiscard]] std::vector<char> bore_sides(const TriangleSoup& soup, const Segmentation& s,
                                           const std::vector<RegionFacts>& facts,
                                           const std::vector<Eigen::Vector3d>& normals,
                                           const std::vector<double>& face_area,
                                           const Visibility& visibility);

}  // namespace meshwind
