#include "core/text/text_file.h"

#include <fstream>
#include <sstream>

#include "core/error.h"

namespace meshwind {

std::string read_text_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    std::error_code error;
    const bool readable = stream && !std::filesystem::is_directory(file, error);
    // Streaming an empty file would set the fail bit of `text`.
    if (!readable ||
        (stream.peek() != std::ifstream::traits_type::eof() && !(text << stream.rdbuf()))) {
        throw IoError("io.cannot_read", file.string(),
                      "cannot be read; check the name and the rights");
    }
    return text.str();
}

}  // namespace meshwind
