/// Names of what belongs to one of several layers and fibres: "program.ngc" and "path.csv" for the
/// first of both, "program-2.ngc" for the second fibre, "program-layer-3-2.ngc" for the second
/// fibre of the third layer.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace meshwind {

/// \param fibre counted from 0
[[nodiscard]] std::string fibre_suffix(std::size_t fibre);

/// \param layer counted from 0
[[nodiscard]] std::string layer_suffix(std::size_t layer);

/// Layer and fibre in the name of a program; empty where there is none.
[[nodiscard]] std::string suffix_of(const std::filesystem::path& program);

/// Whether a run writes files of this name. \param program_extension with the point
[[nodiscard]] bool is_run_file(const std::filesystem::path& name,
                               std::string_view program_extension);

}  // namespace meshwind
