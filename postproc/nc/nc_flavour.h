/// Properties of a G-code dialect, shared by its writer and its reader.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "postproc/motion/program_head.h"
#include "postproc/nc/feed_rule.h"
#include "postproc/nc/linuxcnc_words.h"
#include "postproc/nc/program_flow.h"

namespace meshwind {

/// A code without effect on the axes' motion, and the letters that may stand beside it.
struct NcHarmless {
    int tenths = 0;  ///< G61.1 is 611
    std::string_view parameters{};
    bool path = false;  ///< it sets the path mode at corners (PathMode)
};

/// The row of a code; null where it is none of these.
[[nodiscard]] const NcHarmless* find_harmless(std::span<const NcHarmless> codes, int tenths);

/// The mode that a code asks for with its parameters in the line, numbers as short as they can be.
/// \pre code.path
[[nodiscard]] PathMode asked_path_mode(const NcHarmless& code, const NcLine& line);

/// Characters of a line that count for the controller's limit of its length.
enum class NcCounted {
    All,
    UpToComment,  ///< text behind ; is dropped before
    Code,         ///< blanks and comments in brackets do not count either
};

/// Form of repeated circuits.
enum class NcRepeats {
    None,
    Subprograms,  ///< O1001 .. M99 behind the end, M98 P1001 L20
    Sections,  ///< CIRCUIT_1: .. CIRCUIT_1_END: in its place, REPEAT CIRCUIT_1 CIRCUIT_1_END P=19
};

/// Conversion of text to positions in a controller that keeps them in 32-bit floats.
enum class Float32Text {
    None,        ///< positions are exact enough
    Rounded,     ///< to the nearest float
    ByHundreds,  ///< digits as an integer, times 0.01 and 0.1 in floats, eight digits at most
};

struct NcFlavour {
    using Flow = ProgramFlow (*)(std::span<const std::string_view> lines, const std::string& file);

    std::string_view dialect;     ///< its name
    std::string_view controller;  ///< as messages name it
    std::string_view extension;

    // Axes.
    std::string_view letters;    ///< in the order in which they are written
    bool typed_letters = false;  ///< A B C must be rotary, the others linear
    bool free_xyz = false;       ///< but X Y Z may be either

    // Text.
    NcComments comments = NcComments::BracketsOrSemicolon;
    std::string_view not_in_comments{};  ///< characters with a meaning even there
    char stand_in = '?';                 ///< written in their place
    std::size_t line_length = 252;       ///< characters of a line
    NcCounted counted = NcCounted::All;
    std::size_t most_digits = 0;  ///< of a number, leading zeros as well; 0: any
    bool needs_point = false;     ///< in every number of an axis and F
    bool one_command = false;     ///< one G or M a line, in front, in upper case
    bool percent = false;         ///< % in the first and in the last line
    bool o_number = false;        ///< O0001 (TITLE) in the second

    // Modes.
    std::string_view first_modes;    ///< lines
    std::string_view absolute;       ///< before the start moves, e.g. "G90 "
    std::string_view message;        ///< before a comment that the operator is shown
    std::string_view tie_on;         ///< that comment before the stop
    std::string_view winding_modes;  ///< after the stop, without the feed mode
    bool inverse_time = true;        ///< G93 may be written
    bool per_minute = false;         ///< G94, or nothing else, may be written
    bool has_feed_modes = true;      ///< G93 and G94 are known
    FeedRule feed_rule = FeedRule::Euclid;
    bool rapid_by_feed = false;        ///< G0 runs at F as G1 does
    std::string_view no_per_minute{};  ///< why a feed per minute is not possible, in a message
    /// Default of a controller that slows down at corners by it (junction_time.h); 0: it keeps the
    /// durations.
    double junction_deviation_mm = 0.0;
    bool blends_blocks = false;  ///< it runs each from rest to rest and blends them (blend_time.h)
    SlowLinear slow_linear{};

    // End.
    std::string_view end;            ///< line that ends the main program
    std::string_view end_comment{};  ///< a comment of these words instead
    bool runs_on = false;            ///< lines behind the end would be run

    NcRepeats repeats = NcRepeats::None;
    Flow flow = nullptr;  ///< none: line after line
    Float32Text float32 = Float32Text::None;
    int finest_binary = 9;  ///< 2^-9 is the finest step for float32 sums

    std::span<const NcHarmless> harmless_g{};
    std::span<const NcHarmless> harmless_m{};
    std::span<const std::string_view> harmless_words{};  ///< e.g. SOFT; ADIS= takes a number
};

/// Every flavour, one row each.
[[nodiscard]] std::span<const NcFlavour* const> nc_flavours();

[[nodiscard]] const NcFlavour& linuxcnc_flavour();
[[nodiscard]] const NcFlavour& fanuc_flavour();
[[nodiscard]] const NcFlavour& siemens_flavour();
[[nodiscard]] const NcFlavour& grbl_flavour();
[[nodiscard]] const NcFlavour& marlin_flavour();

}  // namespace meshwind
