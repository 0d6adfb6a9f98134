/// Checks of shape dimensions, with one wording for all shapes.
#pragma once

namespace meshwind {

/// \throws InputError make.not_positive with `name` as the place; refuses NaN and infinity too
void require_positive(const char* name, double value);

/// \throws InputError make.negative with `name` as the place; refuses NaN and infinity too
void require_not_negative(const char* name, double value);

/// \param rule words between the value and its limit, e.g. "less than the run radius"
/// \throws InputError `code` with `name` as the place when `holds` is false
void require(bool holds, const char* code, const char* name, double value, const char* rule,
             double limit);

}  // namespace meshwind
