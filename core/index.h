/// Indices into containers.
#pragma once

#include <cstddef>

namespace meshwind {

/// Meshes number vertices, half-edges and faces from 0 and mean none by -1; containers count
/// without a sign. \pre index >= 0
[[nodiscard]] constexpr std::size_t at(std::ptrdiff_t index) {
    return static_cast<std::size_t>(index);
}

}  // namespace meshwind
