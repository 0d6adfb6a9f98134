/// Atomic writing of a single file: whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace meshwind {

/// Writes `bytes` to `file` in one step: whoever reads it sees the old text or the new one, never a
/// part. Links are followed; a device or pipe (/dev/stdout) is written directly. \throws IoError
/// output.unwritable
void write_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace meshwind
