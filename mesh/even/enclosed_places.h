/// Places that a wall surrounds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// What hangs together of the marked faces, each with all that it cuts off from the largest part of
/// the others, as an O does with its middle. What reaches an end of the wall is left out, and so is
/// what takes more than a share of its area: it goes around a leg. Places may hold others.
/// \param marked per face \param most_parts none is found where marked and other faces hang
/// together in more parts than this: each is looked at from each \return numbers of faces, sorted
[[nodiscard]] std::vector<std::vector<std::int32_t>> enclosed_places(
    const TriangleSoup& wall, const std::vector<char>& marked, double most_share,
    std::size_t most_parts);

}  // namespace meshwind
