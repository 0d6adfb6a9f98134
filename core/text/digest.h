/// Fingerprints of files, for program headers and reports.
#pragma once

#include <string>
#include <string_view>

namespace meshwind {

/// SHA-256 of `bytes` as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

}  // namespace meshwind
