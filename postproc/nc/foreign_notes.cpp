#include "postproc/nc/foreign_notes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/counted.h"
#include "core/text/lower_case.h"
#include "core/text/text_number.h"

namespace meshwind {
namespace {

// A program says in so many lines by whom it is: behind "%" and the title at most.
constexpr std::size_t kLinesOfMaker = 3;

constexpr std::string_view kMadeBy = "meshwind ";

constexpr std::string_view kIdleLetters = "DHKLOPQRST";

// A pause, look-ahead, planes, mm, offsets and cycles off, the workpiece's zero, which is the
// operator's, words on corners.
constexpr std::array kIdleG = {kPauseCode, 80,  90,  170, 180, 190, 210, 400, 490, 540,
                               550,        560, 570, 580, 590, 610, 640, 710, 800};

// Whether code in lower case without blanks has the word "g1", as g01 too.
bool has_word(std::string_view code, char letter, char digit) {
    for (std::size_t i = code.find(letter); i != std::string_view::npos;
         i = code.find(letter, i + 1)) {
        const std::size_t first = std::min(code.find_first_not_of('0', i + 1), code.size());
        const std::size_t last =
            std::min(code.find_first_not_of("0123456789.", i + 1), code.size());
        const std::string_view number = code.substr(first, last - std::min(first, last));
        if (digit == '0' ? number.empty() && last > i + 1 : number == std::string_view(&digit, 1)) {
            return true;
        }
    }
    return false;
}

// Small letters without blanks and comments. NcLine refuses comments that are not closed, and lines
// are looked at here that are never run.
std::string code_alone(NcComments comments, std::string_view text) {
    std::string code;
    bool inside = false;
    for (const char c : text) {
        if (opens_line_comment(c, comments)) {
            break;
        }
        inside = inside || (c == '(' && has_brackets(comments));
        if (!inside && c != ' ' && c != '\t') {
            code += lower_case(c);
        }
        inside = inside && c != ')';
    }
    return code;
}

bool names_meshwind(std::string_view line) {
    const std::size_t at = line.find(kMadeBy);
    if (at == std::string_view::npos) {
        return false;
    }
    const std::size_t opens = line.substr(0, at).find_last_not_of(' ');
    return opens != std::string_view::npos &&
           std::string_view("(;!").find(line[opens]) != std::string_view::npos;
}

std::string times_words(std::size_t times) {
    return times == 1 ? std::string("once") : counted(times, "time");
}

std::string first_words(const ForeignNotes::Seen& seen) {
    return (seen.times == 1 ? ", in line " : ", first in line ") + std::to_string(seen.line);
}

}  // namespace

bool is_by_meshwind(std::span<const std::string_view> lines) {
    const auto first = lines.first(std::min(kLinesOfMaker, lines.size()));
    return std::any_of(first.begin(), first.end(), names_meshwind);
}

ProgramOrigin origin_of(NcComments comments, std::span<const std::string_view> lines) {
    ProgramOrigin origin{.by_meshwind = is_by_meshwind(lines)};
    for (std::size_t i = 0; i < lines.size() && !origin.by_meshwind; ++i) {
        const std::string code = code_alone(comments, lines[i]);
        origin.feeds = origin.feeds || has_word(code, 'g', '1');
        origin.stops = origin.stops || has_word(code, 'm', '0');
    }
    return origin;
}

bool is_idle_g(int tenths) {
    return std::find(kIdleG.begin(), kIdleG.end(), tenths) != kIdleG.end();
}

// All but calls of subprograms and their ends, and M47, which starts again.
bool is_idle_m(int tenths) {
    return tenths != 470 && (tenths < 960 || tenths > 999);
}

bool is_idle_letter(char letter) {
    return kIdleLetters.find(letter) != std::string_view::npos;
}

void ForeignNotes::see(Seen& seen, std::int32_t line) {
    seen.line = seen.times == 0 ? line : seen.line;
    ++seen.times;
}

void ForeignNotes::rounded(const BlockAxis& axis, std::int64_t off_nano) {
    Rounding& rounding = rounded_[axis.letter];
    ++rounding.times;
    rounding.most_nano = std::max(rounding.most_nano, std::abs(off_nano));
    rounding.type = axis.type;
}

void ForeignNotes::rapid_with_fibre(bool by_feed, std::int32_t line) {
    see(rapid_, line);
    rapid_by_feed_ = by_feed;
}

void ForeignNotes::skipped(const NcWord& word) {
    std::string name(1, word.letter);
    if (word.letter == 'G' || word.letter == 'M') {
        name += word.number;
    }
    ++skipped_[name];
}

std::vector<std::string> ForeignNotes::words(bool wound_by_rapids) const {
    std::vector<std::string> all;
    for (const auto& [axis, line] : unplaced_) {
        all.push_back(std::string("axis ") + axis +
                      " has no absolute position before the first feed move, in line " +
                      std::to_string(line) + ": it is taken to stand at 0");
    }
    if (rapid_.times > 0) {
        all.push_back((wound_by_rapids
                           ? "no G1 is in the program: the fibre is taken to be on it from line " +
                                 std::to_string(rapid_.line) + " on, in " +
                                 counted(rapid_.times, "rapid move")
                           : counted(rapid_.times, "rapid move") + " with the fibre on" +
                                 first_words(rapid_)) +
                      (rapid_by_feed_ ? ", which the controller runs at F"
                                      : ", as fast as the machine's axes can"));
    }
    if (set_place_.times > 0) {
        all.push_back("G92 says " + times_words(set_place_.times) + " where axes stand" +
                      first_words(set_place_) + ": they go on from where they are");
    }
    if (inches_.times > 0) {
        all.push_back("linear axes are in inches from line " + std::to_string(inches_.line) +
                      " on");
    }
    for (const auto& [axis, rounding] : rounded_) {
        all.push_back(
            std::string("axis ") + axis + " has " + counted(rounding.times, "position") +
            " between its steps, rounded by up to " +
            fixed(static_cast<double>(rounding.most_nano) / static_cast<double>(kNanoPerUnit), 6) +
            (rounding.type == AxisType::Rotary ? " deg" : " mm"));
    }
    if (!skipped_.empty()) {
        std::string list;
        for (const auto& [word, times] : skipped_) {
            list += (list.empty() ? "" : ", ") + word + " (" + std::to_string(times) + ")";
        }
        all.push_back("left out, for they move no axis: " + list);
    }
    if (!no_end_.empty()) {
        all.push_back("the program has no " + no_end_ + ": it is taken to end with the file");
    }
    return all;
}

}  // namespace meshwind
