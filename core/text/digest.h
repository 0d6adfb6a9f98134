/// Fingerprints of files, for program headers and reports.
#pragma once

#include <string>
#include <string_view>

namespace meshwind {

/// SHA-256 of `bytes` as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

/// "sha256/128 " and the first 32 of them, which fit in a comment of every controller.
[[nodiscard]] std::string short_digest(std::string_view bytes);

}  // namespace meshwind
