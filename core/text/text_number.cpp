#include "core/text/text_number.h"

#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/units.h"

namespace meshwind {

void append_fixed(std::string& text, double value, int decimals) {
    assert(std::isfinite(value));
    std::array<char, 400> buffer;  // 309 digits before the point, the rest after it
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                            std::chars_format::fixed, decimals);
    assert(error == std::errc{});
    (void)error;
    std::string_view digits(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
    if (digits.front() == '-' && digits.find_first_not_of("-0.") == std::string_view::npos) {
        digits.remove_prefix(1);
    }
    text.append(digits);
}

void append_shortest(std::string& text, double value) {
    assert(std::isfinite(value));
    std::array<char, 32> buffer;
    const auto [end, error] =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0);
    assert(error == std::errc{});
    (void)error;
    text.append(buffer.data(), end);
}

std::string fixed(double value, int decimals) {
    std::string text;
    append_fixed(text, value, decimals);
    return text;
}

FixedPair fixed_apart(double value, double limit, int decimals) {
    constexpr int kMaxDecimals = 17;  // doubles of a size around 1 differ before that
    FixedPair pair{fixed(value, decimals), fixed(limit, decimals)};
    for (int more = decimals + 1; pair.value == pair.limit && value != limit; ++more) {
        pair = {fixed(value, more), fixed(limit, more)};
        if (more >= kMaxDecimals) {
            pair = {{}, {}};
            append_shortest(pair.value, value);
            append_shortest(pair.limit, limit);
        }
    }
    return pair;
}

std::string degrees(double angle_rad, int decimals) {
    return fixed(deg_from_rad(angle_rad), decimals) + " deg";
}

std::string percent(double share, int decimals) {
    return fixed(100.0 * share, decimals) + " %";
}

}  // namespace meshwind
