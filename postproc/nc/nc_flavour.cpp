#include "postproc/nc/nc_flavour.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/text/text_number.h"
#include "postproc/motion/junction_time.h"
#include "postproc/nc/linuxcnc.h"
#include "postproc/nc/linuxcnc_flow.h"
#include "postproc/nc/siemens_flow.h"

namespace meshwind {
namespace {

constexpr std::string_view kTieOn = "tie the fibre on at the landing point, then start again";

constexpr std::array<NcHarmless, 8> kLinuxCncG = {
    {{170}, {210}, {400}, {490}, {540}, {610, "", true}, {611, "", true}, {640, "PQ", true}}};

// G05.1 and G08 are look-ahead.
constexpr std::array<NcHarmless, 9> kFanucG = {
    {{51, "Q"}, {80, "P"}, {170}, {210}, {400}, {490}, {540}, {610, "", true}, {640, "", true}}};

constexpr std::array<NcHarmless, 13> kSiemensG = {{{170},
                                                   {400},
                                                   {540},
                                                   {600, "", true},
                                                   {640, "", true},
                                                   {710},
                                                   {5000},
                                                   {6410, "", true},
                                                   {6420, "", true},
                                                   {6430, "", true},
                                                   {6440, "", true},
                                                   {6450, "", true},
                                                   {7100}}};
constexpr std::array<std::string_view, 8> kSiemensWords = {"SOFT",  "BRISK",  "DRIVE", "FFWON",
                                                           "FFWOF", "COMPOF", "ADIS=", "ADISPOS="};

constexpr std::array<NcHarmless, 6> kGrblG = {{{170}, {210}, {400}, {490}, {540}, {610, "", true}}};

constexpr std::array<NcHarmless, 1> kMarlinG = {{{210}}};
// Motors on, kinds of E, speeds, accelerations, jerk.
constexpr std::string_view kSettings = "ABCEFIJKPRSTUVWXYZ";
constexpr std::array<NcHarmless, 8> kMarlinM = {{{170},
                                                 {820},
                                                 {830},
                                                 {2010, kSettings},
                                                 {2030, kSettings},
                                                 {2040, kSettings},
                                                 {2050, kSettings},
                                                 {4000}}};

// The interpreter's floor of length * F is 0.1 mm/min; a block below the first value is split, and
// its linear part then has the second one, clear of the floor by more than F's last digit.
constexpr SlowLinear kLinuxCncSlow{.least_feed_mm_min = 0.12, .split_feed_mm_min = 0.2};

// The planner takes the length of a block from whole motor steps and plans no block slower than
// 0.05 mm/s; so a linear part must be some steps long, or over in a moment.
constexpr SlowLinear kMarlinSlow{
    .least_feed_mm_min = 3.6, .split_feed_mm_min = 60.0, .short_steps = 10.0};

constexpr std::string_view kOrder = "XYZABCUVW";

}  // namespace

const NcFlavour& linuxcnc_flavour() {
    static const NcFlavour kFlavour{
        .dialect = "linuxcnc",
        .controller = "LinuxCNC",
        .extension = ".ngc",
        .letters = kOrder,
        .typed_letters = true,
        .line_length = kLinuxCncLineLength,
        .first_modes = "G21 G90 G94 G17 G40 G49 G80\n",
        .absolute = "G90 ",  // again: the controller's own header lines may have changed it
        .message = "MSG, ",
        .tie_on = kTieOn,
        .winding_modes = "G91 ",
        .feed_rule = FeedRule::Nist,
        .no_per_minute = "whose F leaves the rotary axes out",
        .blends_blocks = true,
        .slow_linear = kLinuxCncSlow,
        .end = "M2\n",
        .repeats = NcRepeats::Subprograms,
        .flow = linuxcnc_flow,
        .harmless_g = kLinuxCncG,
    };
    return kFlavour;
}

const NcFlavour& fanuc_flavour() {
    static const NcFlavour kFlavour{
        .dialect = "fanuc",
        .controller = "Fanuc",
        .extension = ".nc",
        .letters = kOrder,
        .comments = NcComments::Brackets,
        .not_in_comments = ";%",  // end of block, end of tape
        .stand_in = '.',
        .line_length = 100,
        .needs_point = true,
        .percent = true,
        .o_number = true,
        .first_modes = "G21 G90 G94 G17 G40 G49\n",
        .absolute = "G90 ",
        .message = "",
        .tie_on = kTieOn,
        .winding_modes = "G91 ",
        .no_per_minute = "where parameters say what F counts beside a turn",
        .end = "M30\n",
        .repeats = NcRepeats::Subprograms,
        .flow = fanuc_flow,
        .harmless_g = kFanucG,
    };
    return kFlavour;
}

const NcFlavour& siemens_flavour() {
    static const NcFlavour kFlavour{
        .dialect = "siemens",
        .controller = "Siemens",
        .extension = ".mpf",
        .letters = kOrder,
        .comments = NcComments::Semicolon,
        .line_length = 200,
        .first_modes = "G71 G17 G90 G94 G40\n",
        .absolute = "G90 ",
        .message = "",
        .tie_on = kTieOn,
        .winding_modes = "G91 ",
        .no_per_minute = "where FGROUP and FGREF say what F counts beside a turn",
        .end = "M30\n",
        .repeats = NcRepeats::Sections,
        .flow = siemens_flow,
        .harmless_g = kSiemensG,
        .harmless_words = kSiemensWords,
    };
    return kFlavour;
}

const NcFlavour& grbl_flavour() {
    static const NcFlavour kFlavour{
        .dialect = "grbl",
        .controller = "GRBL",
        .extension = ".gcode",
        .letters = "XYZABC",
        .not_in_comments = "!?~",  // hold, status and start, wherever they come in the stream
        .stand_in = '_',
        .line_length = 79,
        .counted = NcCounted::Code,
        .most_digits = 8,
        .first_modes = "G21 G90 G94 G17 G40 G49 G80\n",
        .absolute = "G90 ",
        .message = "",
        .tie_on = kTieOn,
        .winding_modes = "G91 ",
        .per_minute = true,
        .junction_deviation_mm = JunctionPlanner{}.deviation_mm,
        .end = "M2\n",
        .runs_on = true,
        .float32 = Float32Text::ByHundreds,
        .finest_binary = 6,  // six decimals leave two of the eight digits before the point
        .harmless_g = kGrblG,
    };
    return kFlavour;
}

const NcFlavour& marlin_flavour() {
    static const NcFlavour kFlavour{
        .dialect = "marlin",
        .controller = "Marlin",
        .extension = ".gcode",
        .letters = kOrder,
        .typed_letters = true,
        .free_xyz = true,
        .comments = NcComments::Semicolon,
        .line_length = 95,
        .counted = NcCounted::UpToComment,  // queue.cpp stores no character behind ;
        .one_command = true,
        .first_modes = "G21\nG90\n",
        .absolute = "G90\n",
        .message = "",
        .tie_on = kTieOn,
        .winding_modes = "G91\n",
        .inverse_time = false,
        .per_minute = true,
        .has_feed_modes = false,
        .feed_rule = FeedRule::Nist,
        .rapid_by_feed = true,
        .slow_linear = kMarlinSlow,
        .end = "",
        .end_comment = "end of program",
        .runs_on = true,
        .float32 = Float32Text::Rounded,
        .finest_binary = 8,  // six axes of eight decimals still fit in a line
        .harmless_g = kMarlinG,
        .harmless_m = kMarlinM,
    };
    return kFlavour;
}

const NcHarmless* find_harmless(std::span<const NcHarmless> codes, int tenths) {
    const auto found = std::find_if(codes.begin(), codes.end(),
                                    [&](const NcHarmless& code) { return code.tenths == tenths; });
    return found == codes.end() ? nullptr : &*found;
}

PathMode asked_path_mode(const NcHarmless& code, const NcLine& line) {
    PathMode mode;
    mode.words = "G" + std::to_string(code.tenths / 10);
    mode.words += code.tenths % 10 == 0 ? "" : "." + std::to_string(code.tenths % 10);
    for (const char letter : code.parameters) {
        for (const NcWord& word : line.words) {
            if (word.letter == letter) {
                const double value =
                    static_cast<double>(line.nano(word)) / static_cast<double>(kNanoPerUnit);
                mode.words += std::string(" ") + letter;
                append_shortest(mode.words, value);
                mode.corner_mm = letter == 'P' && value > 0.0 ? value : mode.corner_mm;
            }
        }
    }
    return mode;
}

std::span<const NcFlavour* const> nc_flavours() {
    static const std::array kFlavours = {&linuxcnc_flavour(), &fanuc_flavour(), &siemens_flavour(),
                                         &grbl_flavour(), &marlin_flavour()};
    return kFlavours;
}

}  // namespace meshwind
