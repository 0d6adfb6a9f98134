/// Exact decimal text of integers counted in 1e-9 units.
#pragma once

#include <cstdint>
#include <string>

namespace meshwind {

/// Appends nano * 1e-9 with `decimals` digits after the point (0..9; the digits beyond are zero by
/// contract); no exponent, no "-0", no point when there are no decimals.
void append_nano(std::string& text, std::int64_t nano, int decimals);

/// Appends a positive number with at least six significant digits and no exponent; trailing zeros
/// after the point are dropped. \pre 1e-300 < value < 1e300
void append_significant(std::string& text, double value);

}  // namespace meshwind
