/// File names of a run's output. "program.ngc" and "path.csv" belong to the first layer and fibre,
/// "program-2.ngc" to the second fibre, "program-layer-3-2.ngc" to the second fibre of the third
/// layer.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace meshwind {

/// \param fibre counted from 0
[[nodiscard]] std::string fibre_suffix(std::size_t fibre);

/// \param layer counted from 0
[[nodiscard]] std::string layer_suffix(std::size_t layer);

/// Layer and fibre in the name of a program; empty where there is none.
[[nodiscard]] std::string suffix_of(const std::filesystem::path& program);

/// The layer in the name of a program, counted from 0; 0 where there is none.
[[nodiscard]] std::size_t layer_of(const std::filesystem::path& program);

/// The mandrel with the layers before this one on it. \param layer counted from 0, >= 1
[[nodiscard]] std::string grown_mandrel_name(std::size_t layer);

}  // namespace meshwind
