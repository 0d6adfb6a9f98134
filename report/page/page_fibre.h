/// Fibre and motion of a page: stations, blocks and text of a program.
/// Included by .cpp files of the report only.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "pipeline/wind.h"
#include "report/page/page_arrays.h"

namespace meshwind {

/// Amount of a run's fibres, blocks and text that its page shows.
struct PageExtent {
    const Setup& first;             ///< of the run's first layer
    bool usable = false;            ///< Run::usable: else no program is named or listed
    std::size_t station_every = 1;  ///< in the page, and both ends of each piece
    std::size_t block_every = 1;    ///< in the page, and the last one
    std::size_t text_bytes = 0;     ///< of all programs
};

/// A fibre of a layer, and where its arrays are.
struct ShownFibre {
    const WoundLayer& layer;
    std::span<const Piece> pieces;
    const FibreProgram& program;
    std::size_t first_course = 0;  ///< its number in the layer
    std::string prefix;            ///< of the names of its arrays
};

[[nodiscard]] PageExtent page_extent(const Run& run);

/// The fibre's entry in the page's header; adds its arrays.
[[nodiscard]] nlohmann::json page_fibre(const ShownFibre& fibre, const PageExtent& extent,
                                        PageArrays& arrays);

}  // namespace meshwind
