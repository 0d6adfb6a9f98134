#include "postproc/nc/nc_writer.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/text/decimal_text.h"
#include "core/text/text_number.h"
#include "postproc/nc/nc_reader.h"

namespace meshwind {
namespace {

constexpr double kSecondsPerMinute = 60.0;
// Numbers of subprograms count from here, clear of those that people give to programs.
constexpr std::size_t kFirstSubprogram = 1001;
// Text per line in bytes, to reserve the output once.
constexpr std::size_t kTypicalLine = 64;
// F has so many digits, and never fewer than the second.
constexpr int kFeedDigits = 6;
constexpr int kMinFeedDigits = 4;
// Of the title behind O0001; older controls show no more.
constexpr std::size_t kTitleLength = 32;

void check_letters(const NcFlavour& flavour, const Machine& machine, const BlockList& list) {
    for (const BlockAxis& axis : list.axes) {
        const bool rotary_letter = axis.letter >= 'A' && axis.letter <= 'C';
        const bool free = flavour.free_xyz && axis.letter >= 'X';
        const bool fits =
            !flavour.typed_letters || free || (axis.type == AxisType::Rotary) == rotary_letter;
        if (flavour.letters.find(axis.letter) == std::string_view::npos || !fits) {
            const std::string kinds =
                !flavour.typed_letters
                    ? std::string(flavour.letters) + " of either kind"
                    : std::string(flavour.free_xyz ? "X Y Z of either kind, U V W"
                                                   : "X Y Z U V W") +
                          " linear and A B C rotary";
            throw InputError("dialect.axis_letter", machine.name,
                             std::string("axis ") + axis.letter + " cannot be written; " +
                                 std::string(flavour.controller) + " has " + kinds);
        }
    }
}

void check_feed(const NcFlavour& flavour, const Machine& machine) {
    const bool inverse = machine.controller.feed == FeedMode::InverseTime;
    if (!inverse && !flavour.per_minute) {
        throw InputError("dialect.feed", machine.name,
                         "feed per minute is not written for " + std::string(flavour.controller) +
                             ", " + std::string(flavour.no_per_minute) +
                             "; choose \"inverse-time\"");
    }
    if (inverse && !flavour.inverse_time) {
        throw InputError(
            "dialect.feed", machine.name,
            std::string(flavour.controller) + " has no inverse-time feed; choose \"per-minute\"");
    }
}

// What is written.
struct NcSource {
    const NcFlavour& flavour;
    const Machine& machine;
    const BlockList& list;
    const ProgramHeader& header;
    double time_s = 0.0;               // of a run
    std::vector<int> decimals{};       // of the axes
    std::vector<std::size_t> order{};  // in which a line has them

    [[nodiscard]] bool inverse_time() const {
        return machine.controller.feed == FeedMode::InverseTime;
    }
    [[nodiscard]] std::int32_t number() const {
        return machine.controller.program_number.value_or(1);
    }
};

NcSource source_of(const NcFlavour& flavour, const Machine& machine, const BlockList& list,
                   const ProgramHeader& header) {
    NcSource source{flavour, machine, list, header, nc_run_time_s(flavour, machine, list)};
    for (const BlockAxis& axis : list.axes) {
        source.decimals.push_back(decimals_of(axis.resolution_nano));
    }
    // X Y Z A B C U V W is what an operator expects, whatever the order of the chains.
    for (const char letter : flavour.letters) {
        for (std::size_t a = 0; a < list.axes.size(); ++a) {
            if (list.axes[a].letter == letter) {
                source.order.push_back(a);
            }
        }
    }
    return source;
}

std::string head_text(const NcSource& source) {
    const NcFlavour& flavour = source.flavour;
    std::string text = flavour.percent ? "%\n" : "";
    if (flavour.o_number) {
        std::string number = std::to_string(source.number());
        number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
        std::string title =
            source.header.mandrel.empty() ? source.machine.name : source.header.mandrel;
        title.resize(std::min(title.size(), kTitleLength));
        for (char& c : title) {
            c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        }
        text += "O" + number + ' ' + comment_lines(flavour, title);
    }
    for (std::string& words :
         head_comments(flavour, source.machine, source.list, source.header, source.time_s)) {
        text += comment_lines(flavour, std::move(words));
    }
    return text;
}

// The controller's own lines.
std::string own_lines(const NcSource& source, const std::vector<std::string>& lines) {
    const LineValues values =
        line_values(source.flavour, source.machine, source.list, source.header, source.time_s);
    std::string text;
    for (const std::string& line : filled_lines(lines, values, source.machine.name)) {
        check_own_line(source.flavour, source.machine, line);
        text += line + '\n';
    }
    return text;
}

std::size_t digits_of(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }));
}

// \param nano of an axis
void append_position(const NcSource& source, std::int64_t nano, std::size_t axis, std::size_t block,
                     std::string& to) {
    const NcFlavour& flavour = source.flavour;
    const std::size_t begin = to.size();
    append_nano(to, nano, source.decimals[axis]);
    if (flavour.needs_point && source.decimals[axis] == 0) {
        to += '.';
    } else if (flavour.most_digits > 0) {
        if (digits_of(std::string_view(to).substr(begin)) > flavour.most_digits) {
            throw InputError("dialect.digits", "block " + std::to_string(block),
                             std::string("axis ") + source.list.axes[axis].letter + ": \"" +
                                 to.substr(begin) + "\" has more than the " +
                                 std::to_string(flavour.most_digits) + " digits that " +
                                 std::string(flavour.controller) +
                                 " reads; give the axis a coarser resolution");
        }
    }
}

// Moves to the start.
struct StartWords {
    std::string absolute;
    std::string rest;  // incremental, what the controller could not read in one word
};

// A start of too many digits is taken in whole units first.
void append_start(const NcSource& source, std::size_t axis, StartWords& words) {
    const std::int64_t nano = source.list.row(0)[axis];
    const std::int64_t whole = nano / kNanoPerUnit * kNanoPerUnit;
    const std::string letter = std::string(" ") + source.list.axes[axis].letter;
    std::string all;
    append_nano(all, nano, source.decimals[axis]);
    words.absolute += letter;
    if (source.flavour.most_digits > 0 && digits_of(all) > source.flavour.most_digits) {
        append_nano(words.absolute, whole, 0);
        words.rest += letter;
        append_position(source, nano - whole, axis, 0, words.rest);
    } else {
        append_position(source, nano, axis, 0, words.absolute);
    }
}

std::string start_moves(const NcSource& source) {
    std::string text;
    for (const AxisType type : {AxisType::Rotary, AxisType::Linear}) {
        StartWords words;
        for (const std::size_t a : source.order) {
            if (source.list.axes[a].type == type) {
                append_start(source, a, words);
            }
        }
        if (!words.absolute.empty()) {
            text += std::string(source.flavour.absolute) + "G0" + words.absolute + '\n';
        }
        if (!words.rest.empty()) {
            text += "G91 G0" + words.rest + '\n';
        }
    }
    return text;
}

// To the start, and the stop there.
std::string approach_text(const NcSource& source) {
    const NcFlavour& flavour = source.flavour;
    const ProgramHeader& header = source.header;
    const bool continues_fibre = !header.goes_on_from.empty();
    std::string text = comment_lines(
        flavour, "approach: rotary axes turn first, then the linear axes move together;");
    text += comment_lines(
        flavour, continues_fibre ? "the eye stands nearly there, the fibre stays on"
                                 : "bring the eye clear of the mandrel by hand before the start");
    text += start_moves(source);
    text += comment_lines(
        flavour,
        std::string(flavour.message) +
            (header.in_the_air ? std::string("no fibre for this run in the air, start again")
             : continues_fibre ? std::string("the fibre is on already, start again")
                               : std::string(flavour.tie_on)));
    text += "M0\n";
    return text;
}

// As many significant digits as the controller reads when it counts leading zeros.
void append_short(const NcSource& source, double value, std::size_t block, std::string& text) {
    const auto most_digits = static_cast<int>(source.flavour.most_digits);
    const int whole = std::max(static_cast<int>(std::floor(std::log10(value))) + 1, 1);
    const int leading = whole - static_cast<int>(std::floor(std::log10(value))) - 1;
    const int decimals = std::min(kFeedDigits + leading - whole, most_digits - whole);
    if (whole >= most_digits || whole + decimals - leading < kMinFeedDigits) {
        throw InputError("dialect.duration", "block " + std::to_string(block),
                         "takes " + fixed(source.list.blocks[block].duration_s, 6) +
                             " s, which F cannot say in the digits that " +
                             std::string(source.flavour.controller) + " reads");
    }
    append_fixed(text, value, std::max(decimals, 0));
    if (decimals > 0) {
        text.erase(text.find_last_not_of('0') + 1);
        text.erase(text.find_last_not_of('.') + 1);
    }
}

void append_feed(const NcSource& source, std::size_t block, std::string& text) {
    const BlockList& list = source.list;
    const double duration_s = list.blocks[block].duration_s;
    if (!(duration_s > 0.0)) {
        throw InputError("dialect.duration", "block " + std::to_string(block),
                         "takes no time; give every block a duration above 0");
    }
    const double length =
        source.inverse_time()
            ? 1.0
            : feed_length(source.flavour.feed_rule,
                          move_lengths(list.axes, list.row(block - 1), list.row(block)));
    const double value = kSecondsPerMinute * length / duration_s;
    text += " F";
    const std::size_t begin = text.size();
    if (source.flavour.most_digits > 0) {
        append_short(source, value, block, text);
    } else {
        append_significant(text, value);
    }
    if (source.flavour.needs_point && text.find('.', begin) == std::string::npos) {
        text += '.';
    }
}

// Blanks may be left out of the line that begins at `begin`.
void fit_line(const NcFlavour& flavour, std::size_t begin, std::size_t block, std::string& text) {
    const auto first = text.begin() + static_cast<std::ptrdiff_t>(begin);
    text.erase(std::remove(first, text.end(), ' '), text.end());
    if (text.size() - begin > flavour.line_length) {
        throw InputError("dialect.long_line", "block " + std::to_string(block),
                         "its line has " + std::to_string(text.size() - begin) + " characters, " +
                             std::string(flavour.controller) + " reads at most " +
                             std::to_string(flavour.line_length) +
                             "; give the axes coarser resolutions");
    }
}

void append_block(const NcSource& source, std::size_t block, std::string& text) {
    const std::span<const std::int64_t> now = source.list.row(block);
    const std::span<const std::int64_t> before = source.list.row(block - 1);
    const std::size_t begin = text.size();
    if (std::equal(now.begin(), now.end(), before.begin())) {
        throw InputError("dialect.duration", "block " + std::to_string(block),
                         "moves no axis, so that no feed tells its time; join it with the "
                         "next one");
    }
    text += "G1";
    for (const std::size_t a : source.order) {
        if (now[a] != before[a]) {
            text += ' ';
            text += source.list.axes[a].letter;
            append_position(source, now[a] - before[a], a, block, text);
        }
    }
    append_feed(source, block, text);
    if (text.size() - begin > source.flavour.line_length) {
        fit_line(source.flavour, begin, block, text);
    }
    text += '\n';
}

// The number of the first one, clear of the program's own.
std::size_t first_subprogram(const NcSource& source, const ProgramLayout& layout) {
    const auto own = static_cast<std::size_t>(source.number());
    const bool taken = source.flavour.o_number && own >= kFirstSubprogram &&
                       own < kFirstSubprogram + layout.subprograms.size();
    return taken ? own + 1 : kFirstSubprogram;
}

// Writes the blocks as they are laid out, with a mark where a course begins.
class LayoutWriter {
public:
    LayoutWriter(const NcSource& source, const ProgramLayout& layout, std::string& text)
        : source_(source),
          layout_(layout),
          first_subprogram_(first_subprogram(source, layout)),
          written_(layout.subprograms.size(), false),
          text_(text) {}

    void main() {
        if (layout_.main.empty()) {
            const ProgramPart all{.first = 1, .last = source_.list.blocks.size() - 1};
            parts({&all, 1});
        } else {
            parts(layout_.main);
        }
    }

    void subprograms() {
        marks_ = false;
        for (std::size_t s = 0; s < layout_.subprograms.size(); ++s) {
            text_ += "O" + std::to_string(first_subprogram_ + s) + '\n';
            parts(layout_.subprograms[s]);
            text_ += "M99\n";
        }
    }

private:
    void parts(std::span<const ProgramPart> parts) {
        for (const ProgramPart& part : parts) {
            if (part.kind == ProgramPart::Kind::Call) {
                mark(part.first);
                call(part);
                continue;
            }
            for (std::size_t i = part.first; i <= part.last; ++i) {
                mark(i);
                append_block(source_, i, text_);
            }
        }
    }

    void call(const ProgramPart& part) {
        const std::size_t s = part.subprogram;
        std::int64_t times = part.times;
        if (source_.flavour.repeats == NcRepeats::Subprograms) {
            text_ += "M98 P" + std::to_string(first_subprogram_ + s);
            text_ += times > 1 ? " L" + std::to_string(times) + '\n' : "\n";
            return;
        }
        const std::string label = "CIRCUIT_" + std::to_string(s + 1);
        if (!written_[s]) {
            // The first time it stands in its place.
            written_[s] = true;
            text_ += label + ":\n";
            const bool marks = std::exchange(marks_, false);
            parts(layout_.subprograms[s]);
            marks_ = marks;
            text_ += label + "_END:\n";
            --times;
        }
        if (times > 0) {
            text_ += "REPEAT " + label + ' ' + label + "_END P=" + std::to_string(times) + '\n';
        }
    }

    void mark(std::size_t block) {
        const std::int32_t piece = source_.list.blocks[block].piece;
        if (marks_ && piece != piece_) {
            piece_ = piece;
            text_ += comment_lines(source_.flavour, "course " + std::to_string(piece_));
        }
    }

    const NcSource& source_;
    const ProgramLayout& layout_;
    std::size_t first_subprogram_;
    std::vector<bool> written_;  // sections that stand in their place already
    std::string& text_;
    std::int32_t piece_ = -1;  // of the last course mark
    bool marks_ = true;
};

}  // namespace

std::string write_nc(const NcFlavour& flavour, const Machine& machine, const BlockList& list,
                     const ProgramLayout& layout, const ProgramHeader& header) {
    assert(!list.blocks.empty() && list.axes.size() == machine.axis_count());
    check_letters(flavour, machine, list);
    check_feed(flavour, machine);
    const NcSource source = source_of(flavour, machine, list, header);
    std::string text;
    text.reserve(kTypicalLine * (list.blocks.size() + 40));
    text += head_text(source);
    text += flavour.first_modes;
    text += own_lines(source, machine.controller.header);
    text += approach_text(source);
    text += flavour.winding_modes;
    text += !flavour.has_feed_modes ? "" : source.inverse_time() ? "G93\n" : "G94\n";
    LayoutWriter blocks(source, layout, text);
    blocks.main();
    text += own_lines(source, machine.controller.footer);
    text += flavour.end;
    if (!flavour.end_comment.empty()) {
        text += comment_lines(flavour, std::string(flavour.end_comment));
    }
    if (flavour.repeats == NcRepeats::Subprograms) {
        blocks.subprograms();
    }
    text += flavour.percent ? "%\n" : "";
    return text;
}

}  // namespace meshwind
