/// Whole files as text.
#pragma once

#include <filesystem>
#include <string>

namespace meshwind {

/// The bytes of a file, pipes and devices included. \throws IoError io.cannot_read
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file);

}  // namespace meshwind
