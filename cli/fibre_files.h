/// Names of what belongs to one of several fibres: "program.ngc" and "path.csv" for the first,
/// "program-2.ngc" and "path-2.csv" for the second.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace meshwind {

/// \param fibre counted from 0
[[nodiscard]] inline std::string fibre_suffix(std::size_t fibre) {
    return fibre == 0 ? "" : "-" + std::to_string(fibre + 1);
}

/// The suffix in the name of a program; empty where there is none.
[[nodiscard]] inline std::string fibre_suffix_of(const std::filesystem::path& program) {
    const std::string stem = program.stem().string();
    const std::size_t dash = stem.rfind('-');
    const bool numbered = dash != std::string::npos && dash + 1 < stem.size() &&
                          stem.find_first_not_of("0123456789", dash + 1) == std::string::npos;
    return numbered ? stem.substr(dash) : "";
}

}  // namespace meshwind
