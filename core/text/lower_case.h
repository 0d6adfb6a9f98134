/// Text in small letters.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace meshwind {

/// A to Z as a to z, all else as it is, whatever the locale.
[[nodiscard]] constexpr char lower_case(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

[[nodiscard]] inline std::string lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) { return lower_case(c); });
    return lower;
}

}  // namespace meshwind
