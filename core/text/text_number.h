/// Numbers as text: locale-free, reproducible, never "-0.000".
#pragma once

#include <string>

namespace meshwind {

/// Appends `value` with exactly `decimals` digits after the point (>= 0). A value that rounds to
/// zero carries no sign. \pre value is finite
void append_fixed(std::string& text, double value, int decimals);

/// Appends the shortest decimal text that reads back as `value`. \pre value is finite
void append_shortest(std::string& text, double value);

/// `append_fixed` on an empty string.
[[nodiscard]] std::string fixed(double value, int decimals);

/// A value and the limit that it breaks, as texts that differ.
struct FixedPair {
    std::string value;
    std::string limit;
};

/// Both with `decimals` digits after the point, or with as many more as show which is larger; with
/// 17 digits in all they are shown as they are. \pre both are finite
[[nodiscard]] FixedPair fixed_apart(double value, double limit, int decimals);

/// "54.74 deg". \pre angle_rad is finite
[[nodiscard]] std::string degrees(double angle_rad, int decimals = 2);

/// "12.50 %" of a share of 0.125. \pre share is finite
[[nodiscard]] std::string percent(double share, int decimals = 2);

}  // namespace meshwind
