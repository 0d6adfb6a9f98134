#include "core/text/decimal_text.h"

#include <array>
#include <cassert>
#include <charconv>
#include <cmath>

#include "core/text/text_number.h"

namespace meshwind {
namespace {

constexpr int kNanoDecimals = 9;
constexpr std::array<std::uint64_t, 10> kTenTo = {
    1, 10, 100, 1'000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000, 1'000'000'000};

// Writes `value` / 10^decimals.
void append_scaled(std::string& text, std::uint64_t value, int decimals) {
    std::array<char, 32> buffer;
    const std::uint64_t whole = value / kTenTo[static_cast<std::size_t>(decimals)];
    std::uint64_t part = value % kTenTo[static_cast<std::size_t>(decimals)];
    char* end = std::to_chars(buffer.data(), buffer.data() + 21, whole).ptr;
    if (decimals > 0) {
        *end = '.';
        for (int digit = decimals; digit > 0; --digit) {
            end[digit] = static_cast<char>('0' + part % 10);
            part /= 10;
        }
        end += decimals + 1;
    }
    text.append(buffer.data(), end);
}

}  // namespace

void append_nano(std::string& text, std::int64_t nano, int decimals) {
    assert(decimals >= 0 && decimals <= kNanoDecimals);
    if (nano < 0) {
        text += '-';
    }
    const std::uint64_t size =
        nano < 0 ? 0 - static_cast<std::uint64_t>(nano) : static_cast<std::uint64_t>(nano);
    const std::uint64_t divisor = kTenTo[static_cast<std::size_t>(kNanoDecimals - decimals)];
    assert(size % divisor == 0);
    append_scaled(text, size / divisor, decimals);
}

void append_significant(std::string& text, double value) {
    constexpr double kMinScaled = 1e5;   // six digits
    constexpr double kMaxScaled = 1e15;  // still exact in a double
    assert(value > 0.0 && std::isfinite(value));
    int decimals = 0;
    double scaled = value;
    while (scaled < kMinScaled && decimals < kNanoDecimals) {
        scaled *= 10.0;
        ++decimals;
    }
    if (scaled < kMinScaled || scaled > kMaxScaled) {  // rare: beyond nine decimals or huge
        const int digits = 6 - static_cast<int>(std::floor(std::log10(value)));
        append_fixed(text, value, digits > 0 ? digits : 0);
        return;
    }
    std::uint64_t integer = static_cast<std::uint64_t>(std::llround(scaled));
    while (decimals > 0 && integer % 10 == 0) {
        integer /= 10;
        --decimals;
    }
    append_scaled(text, integer, decimals);
}

}  // namespace meshwind
