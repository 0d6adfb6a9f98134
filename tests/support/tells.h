/// Figures in words that people read: what they are is asserted, not the sentence about them.
#pragma once

#include <cctype>
#include <string>
#include <string_view>

namespace meshwind::test {

/// Whether words have a figure, as "43.2 deg", "line 6" or "7 circuits", whole: 43.2 is neither in
/// 143.2 nor in 43.25.
inline bool tells(std::string_view words, std::string_view figure) {
    const auto of_a_number = [&](std::size_t i, bool before) {
        const char c = words[i];
        const std::size_t next = before ? i - 1 : i + 1;
        const bool digit_next =
            next < words.size() && std::isdigit(static_cast<unsigned char>(words[next])) != 0;
        return std::isdigit(static_cast<unsigned char>(c)) != 0 || (c == '.' && digit_next) ||
               (before && c == '-');
    };
    const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
    for (std::size_t at = words.find(figure); at != std::string_view::npos;
         at = words.find(figure, at + 1)) {
        const std::size_t end = at + figure.size();
        const bool begins = at == 0 || !is_digit(figure.front()) || !of_a_number(at - 1, true);
        const bool ends =
            end == words.size() || !is_digit(figure.back()) || !of_a_number(end, false);
        if (begins && ends) {
            return true;
        }
    }
    return false;
}

}  // namespace meshwind::test
