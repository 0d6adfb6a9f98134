/// Finds marked places that are enclosed by a wall.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Connected components of the marked faces, each with all that it cuts off from the largest part
/// of the others, as an O does with its middle. Those that reach an end of the wall are left out,
/// and so are those with more than a share of its area: they go around a leg. Places may contain
/// others.
/// \param marked per face \param most_parts none is found where marked and other faces have more
/// components than this: each is compared with each \return numbers of faces, sorted
[[nodiscard]] std::vector<std::vector<std::int32_t>> enclosed_places(
    const TriangleSoup& wall, const std::vector<char>& marked, double most_share,
    std::size_t most_parts);

}  // namespace meshwind
