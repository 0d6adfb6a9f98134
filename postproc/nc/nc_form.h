/// Checks the form of a line's text against the controller's limits: length, digits, points, steps.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "postproc/motion/block.h"
#include "postproc/nc/linuxcnc_words.h"
#include "postproc/nc/nc_flavour.h"

namespace meshwind {

/// Checks that a line has no more characters than the controller reads, less those that it drops
/// before counting.
/// \param foreign of a program that is not by meshwind: comments and blanks do not count at all
/// \throws InputError nc.long_line, nc.comment
void check_length(const NcFlavour& flavour, bool foreign, std::string_view text, NcLine& line);

/// The text without the words of letters alone that are known to be harmless.
[[nodiscard]] std::string without_harmless_words(const NcFlavour& flavour, std::string_view text);

/// Checks that numbers have a point and few digits, and commands stand alone, where the controller
/// needs that.
/// \param line of the text \param axes letters of the machine \throws InputError nc.digits,
/// nc.number, nc.not_understood
void check_form(const NcFlavour& flavour, bool foreign, std::string_view text, const NcLine& line,
                std::string_view axes);

/// Checks that a position is a multiple of the axis' step, or one that sums in 32-bit floats keep;
/// a foreign program may have any.
/// \param value NcLine::nano of the word \throws InputError nc.resolution
void check_step(const NcFlavour& flavour, bool foreign, const NcLine& line, const NcWord& word,
                const BlockAxis& axis, std::int64_t value);

}  // namespace meshwind
