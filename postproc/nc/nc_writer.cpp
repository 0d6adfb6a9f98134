#include "postproc/nc/nc_writer.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
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
constexpr int kLeastFeedDigits = 4;
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

class Writer {
public:
    Writer(const NcFlavour& flavour, const Machine& machine, const BlockList& list,
           const ProgramHeader& header)
        : flavour_(flavour),
          machine_(machine),
          list_(list),
          header_(header),
          time_s_(nc_run_time_s(flavour, machine, list)) {
        for (const BlockAxis& axis : list.axes) {
            decimals_.push_back(decimals_of(axis.resolution_nano));
        }
        // X Y Z A B C U V W is what an operator expects, whatever the order of the chains.
        for (const char letter : flavour.letters) {
            for (std::size_t a = 0; a < list.axes.size(); ++a) {
                if (list.axes[a].letter == letter) {
                    order_.push_back(a);
                }
            }
        }
        number_ = machine.controller.program_number.value_or(1);
        text_.reserve(kTypicalLine * (list.blocks.size() + 40));
    }

    std::string program(const ProgramLayout& layout) && {
        first_subprogram_ = kFirstSubprogram;
        const auto own = static_cast<std::size_t>(number_);
        if (flavour_.o_number && own >= kFirstSubprogram &&
            own < kFirstSubprogram + layout.subprograms.size()) {
            first_subprogram_ = own + 1;
        }
        head();
        text_ += flavour_.first_modes;
        own_lines(machine_.controller.header);
        comment("approach: rotary axes turn first, then the linear axes move together;");
        const bool goes_on = !header_.goes_on_from.empty();
        comment(goes_on ? "the eye stands nearly there, the fibre stays on"
                        : "bring the eye clear of the mandrel by hand before the start");
        start_moves();
        comment(std::string(flavour_.message) +
                (header_.in_the_air ? std::string("no fibre for this run in the air, start again")
                 : goes_on          ? std::string("the fibre is on already, start again")
                                    : std::string(flavour_.tie_on)));
        text_ += "M0\n";
        text_ += flavour_.winding_modes;
        text_ += !flavour_.has_feed_modes ? "" : inverse() ? "G93\n" : "G94\n";
        std::vector<ProgramPart> main = layout.main;
        if (main.empty()) {
            main.push_back({.first = 1, .last = list_.blocks.size() - 1});
        }
        layout_ = &layout;
        written_.assign(layout.subprograms.size(), false);
        parts(main);
        own_lines(machine_.controller.footer);
        text_ += flavour_.end;
        if (!flavour_.end_comment.empty()) {
            comment(std::string(flavour_.end_comment));
        }
        if (flavour_.repeats == NcRepeats::Subprograms) {
            subprograms(layout);
        }
        text_ += flavour_.percent ? "%\n" : "";
        return std::move(text_);
    }

private:
    [[nodiscard]] bool inverse() const { return machine_.controller.feed == FeedMode::InverseTime; }

    void head() {
        text_ += flavour_.percent ? "%\n" : "";
        if (flavour_.o_number) {
            std::string number = std::to_string(number_);
            number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
            std::string title = header_.mandrel.empty() ? machine_.name : header_.mandrel;
            title.resize(std::min(title.size(), kTitleLength));
            for (char& c : title) {
                c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
            }
            text_ += "O" + number + ' ' + comment_lines(flavour_, title);
        }
        for (std::string& words : head_comments(flavour_, machine_, list_, header_, time_s_)) {
            comment(std::move(words));
        }
    }

    void comment(std::string words) { text_ += comment_lines(flavour_, std::move(words)); }

    void own_lines(const std::vector<std::string>& lines) {
        const LineValues values = line_values(flavour_, machine_, list_, header_, time_s_);
        for (const std::string& line : filled_lines(lines, values, machine_.name)) {
            check_own_line(flavour_, machine_, line);
            text_ += line + '\n';
        }
    }

    void start_moves() {
        for (const AxisType type : {AxisType::Rotary, AxisType::Linear}) {
            std::string words;
            std::string rest;
            for (const std::size_t a : order_) {
                if (list_.axes[a].type == type) {
                    start(a, words, rest);
                }
            }
            if (!words.empty()) {
                text_ += std::string(flavour_.absolute) + "G0" + words + '\n';
            }
            if (!rest.empty()) {
                text_ += "G91 G0" + rest + '\n';
            }
        }
    }

    // A start of too many digits is taken in whole units first.
    void start(std::size_t axis, std::string& words, std::string& rest) {
        const std::int64_t nano = list_.row(0)[axis];
        const std::int64_t whole = nano / kNanoPerUnit * kNanoPerUnit;
        const std::string letter = std::string(" ") + list_.axes[axis].letter;
        std::string all;
        append_nano(all, nano, decimals_[axis]);
        words += letter;
        if (flavour_.most_digits > 0 && digits_of(all) > flavour_.most_digits) {
            append_nano(words, whole, 0);
            rest += letter;
            append_position(rest, nano - whole, axis, 0);
        } else {
            append_position(words, nano, axis, 0);
        }
    }

    static std::size_t digits_of(std::string_view text) {
        return static_cast<std::size_t>(
            std::count_if(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }));
    }

    void append_position(std::string& to, std::int64_t nano, std::size_t axis, std::size_t block) {
        const std::size_t begin = to.size();
        append_nano(to, nano, decimals_[axis]);
        if (flavour_.needs_point && decimals_[axis] == 0) {
            to += '.';
        } else if (flavour_.most_digits > 0) {
            if (digits_of(std::string_view(to).substr(begin)) > flavour_.most_digits) {
                throw InputError("dialect.digits", "block " + std::to_string(block),
                                 std::string("axis ") + list_.axes[axis].letter + ": \"" +
                                     to.substr(begin) + "\" has more than the " +
                                     std::to_string(flavour_.most_digits) + " digits that " +
                                     std::string(flavour_.controller) +
                                     " reads; give the axis a coarser resolution");
            }
        }
    }

    void parts(const std::vector<ProgramPart>& parts) {
        for (const ProgramPart& part : parts) {
            if (part.kind == ProgramPart::Kind::Call) {
                mark(part.first);
                call(part);
                continue;
            }
            for (std::size_t i = part.first; i <= part.last; ++i) {
                mark(i);
                block(i);
            }
        }
    }

    void call(const ProgramPart& part) {
        const std::size_t s = part.subprogram;
        std::int64_t times = part.times;
        if (flavour_.repeats == NcRepeats::Subprograms) {
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
            this->parts(layout_->subprograms[s]);
            marks_ = marks;
            text_ += label + "_END:\n";
            --times;
        }
        if (times > 0) {
            text_ += "REPEAT " + label + ' ' + label + "_END P=" + std::to_string(times) + '\n';
        }
    }

    void subprograms(const ProgramLayout& layout) {
        marks_ = false;
        for (std::size_t s = 0; s < layout.subprograms.size(); ++s) {
            text_ += "O" + std::to_string(first_subprogram_ + s) + '\n';
            parts(layout.subprograms[s]);
            text_ += "M99\n";
        }
    }

    void mark(std::size_t block) {
        if (marks_ && list_.blocks[block].piece != piece_) {
            piece_ = list_.blocks[block].piece;
            comment("course " + std::to_string(piece_));
        }
    }

    void block(std::size_t i) {
        const std::span<const std::int64_t> now = list_.row(i);
        const std::span<const std::int64_t> before = list_.row(i - 1);
        const std::size_t begin = text_.size();
        if (std::equal(now.begin(), now.end(), before.begin())) {
            throw InputError("dialect.duration", "block " + std::to_string(i),
                             "moves no axis, so that no feed tells its time; join it with the "
                             "next one");
        }
        text_ += "G1";
        for (const std::size_t a : order_) {
            if (now[a] != before[a]) {
                text_ += ' ';
                text_ += list_.axes[a].letter;
                append_position(text_, now[a] - before[a], a, i);
            }
        }
        feed(i);
        if (text_.size() - begin > flavour_.line_length) {
            fit_line(begin, i);
        }
        text_ += '\n';
    }

    // Blanks may be left out.
    void fit_line(std::size_t begin, std::size_t i) {
        const auto first = text_.begin() + static_cast<std::ptrdiff_t>(begin);
        text_.erase(std::remove(first, text_.end(), ' '), text_.end());
        if (text_.size() - begin > flavour_.line_length) {
            throw InputError("dialect.long_line", "block " + std::to_string(i),
                             "its line has " + std::to_string(text_.size() - begin) +
                                 " characters, " + std::string(flavour_.controller) +
                                 " reads at most " + std::to_string(flavour_.line_length) +
                                 "; give the axes coarser resolutions");
        }
    }

    void feed(std::size_t i) {
        const double duration_s = list_.blocks[i].duration_s;
        if (!(duration_s > 0.0)) {
            throw InputError("dialect.duration", "block " + std::to_string(i),
                             "takes no time; give every block a duration above 0");
        }
        const double length =
            inverse() ? 1.0
                      : feed_length(flavour_.feed_rule,
                                    move_lengths(list_.axes, list_.row(i - 1), list_.row(i)));
        const double value = kSecondsPerMinute * length / duration_s;
        text_ += " F";
        const std::size_t begin = text_.size();
        if (flavour_.most_digits > 0) {
            append_short(value, i);
        } else {
            append_significant(text_, value);
        }
        if (flavour_.needs_point && text_.find('.', begin) == std::string::npos) {
            text_ += '.';
        }
    }

    // As many significant digits as the controller reads when it counts leading zeros.
    void append_short(double value, std::size_t i) {
        const int whole = std::max(static_cast<int>(std::floor(std::log10(value))) + 1, 1);
        const int leading = whole - static_cast<int>(std::floor(std::log10(value))) - 1;
        const int decimals =
            std::min(kFeedDigits + leading - whole, static_cast<int>(flavour_.most_digits) - whole);
        if (whole >= static_cast<int>(flavour_.most_digits) ||
            whole + decimals - leading < kLeastFeedDigits) {
            throw InputError("dialect.duration", "block " + std::to_string(i),
                             "takes " + fixed(list_.blocks[i].duration_s, 6) +
                                 " s, which F cannot say in the digits that " +
                                 std::string(flavour_.controller) + " reads");
        }
        append_fixed(text_, value, std::max(decimals, 0));
        if (decimals > 0) {
            text_.erase(text_.find_last_not_of('0') + 1);
            text_.erase(text_.find_last_not_of('.') + 1);
        }
    }

    const NcFlavour& flavour_;
    const Machine& machine_;
    const BlockList& list_;
    const ProgramHeader& header_;
    double time_s_;
    const ProgramLayout* layout_ = nullptr;
    std::int32_t number_ = 1;
    std::size_t first_subprogram_ = kFirstSubprogram;
    std::vector<bool> written_;  // sections that stand in their place already
    std::vector<int> decimals_;
    std::vector<std::size_t> order_;
    std::string text_;
    std::int32_t piece_ = -1;  // of the last course mark
    bool marks_ = true;
};

}  // namespace

std::string write_nc(const NcFlavour& flavour, const Machine& machine, const BlockList& list,
                     const ProgramLayout& layout, const ProgramHeader& header) {
    assert(!list.blocks.empty() && list.axes.size() == machine.axis_count());
    check_letters(flavour, machine, list);
    check_feed(flavour, machine);
    return Writer(flavour, machine, list, header).program(layout);
}

}  // namespace meshwind
