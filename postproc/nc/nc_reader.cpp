#include "postproc/nc/nc_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/text/text_number.h"
#include "postproc/nc/float32_steps.h"
#include "postproc/nc/header_lines.h"

namespace meshwind {
namespace {

constexpr double kSecondsPerMinute = 60.0;

// A program needs two to get to its start; each that is kept takes some hundred bytes.
constexpr std::size_t kMostRapidMoves = 1000;

// Lines are run between two looks at whether an end is asked for: some milliseconds.
constexpr std::int64_t kLinesPerLook = 4096;

const NcHarmless* harmless(std::span<const NcHarmless> codes, int tenths) {
    const auto found = std::find_if(codes.begin(), codes.end(),
                                    [&](const NcHarmless& code) { return code.tenths == tenths; });
    return found == codes.end() ? nullptr : &*found;
}

class Reader {
public:
    Reader(const NcFlavour& flavour, std::string file, const Machine& machine)
        : flavour_(flavour), file_(std::move(file)), machine_name_(machine.name) {
        line_.file = &file_;
        line_.style = flavour.comments;
        axis_of_.fill(-1);
        for (std::size_t a = 0; a < machine.axis_count(); ++a) {
            const Axis& axis = machine.axis(a);
            list_.axes.push_back({axis.letter, axis.type, axis.resolution_nano});
            axis_of_[static_cast<std::size_t>(axis.letter - 'A')] = static_cast<int>(a);
        }
        position_.assign(list_.axes.size(), 0);
        placed_.assign(list_.axes.size(), false);
        list_.head.emplace().has_approach = true;
    }

    // Of lines that were read.
    [[nodiscard]] PathMode path_mode() const {
        const std::vector<PathModeFrom>& modes = list_.head->path_modes;
        return modes.empty() ? PathMode{} : modes.back().mode;
    }

    BlockList program(std::string_view text) && {
        const std::vector<std::string_view> lines = lines_of_text(text);
        const ProgramFlow flow = flow_of(lines);
        std::int64_t run = 0;
        run_flow(flow, file_, [&](std::int32_t number, FlowLine kind) {
            if (++run % kLinesPerLook == 0) {
                check_interrupt();
            }
            line_.number = number;
            const std::string_view words = lines[static_cast<std::size_t>(number) - 1];
            if (kind == FlowLine::Code) {
                line(words);
            } else {
                check_length(words);
                (void)line_.split_comments(words);
                comments();
            }
            return !ended_ || flavour_.runs_on;
        });
        if (!ended_) {
            fail("nc.no_end", "the program has no " + end_words() + "; the file may be cut off");
        }
        if (list_.blocks.size() < 2) {
            fail("nc.no_motion", "the program has no feed move; there is nothing to wind");
        }
        if (flavour_.float32 != Float32Text::None) {
            set_binary_steps(list_);
        }
        return std::move(list_);
    }

    void line(std::string_view text) {
        check_length(text);
        if (text == "%" && flavour_.flow != nullptr) {
            ended_ = list_.blocks.empty() ? ended_ : true;
            return;
        }
        line_.split(flavour_.harmless_words.empty() ? text : without_words(text));
        if (ended_ && flavour_.runs_on && !line_.words.empty()) {
            fail("nc.not_understood", "code behind the end would be run; remove it");
        }
        comments();
        check_form(text);
        execute();
    }

    [[nodiscard]] bool moved() const {
        return !list_.blocks.empty() || any_placed_ || ended_ || list_.tie_on_mm.has_value();
    }

private:
    [[noreturn]] void fail(const std::string& code, const std::string& words) const {
        line_.fail(code, words);
    }

    [[nodiscard]] std::string end_words() const {
        std::string end(flavour_.end.substr(0, flavour_.end.find('\n')));
        return end.empty() ? "\"; " + std::string(flavour_.end_comment) + "\"" : end;
    }

    [[nodiscard]] ProgramFlow flow_of(const std::vector<std::string_view>& lines) const {
        if (flavour_.flow != nullptr) {
            return flavour_.flow(lines, file_);
        }
        ProgramFlow flow;
        flow.main.push_back({.first = 1, .last = static_cast<std::int32_t>(lines.size())});
        return flow;
    }

    // Without what the controller drops before it counts.
    void check_length(std::string_view text) {
        std::size_t length = text.size();
        if (length > flavour_.line_length && flavour_.counted == NcCounted::Code) {
            length = line_.split_comments(text).size();
        } else if (length > flavour_.line_length && flavour_.counted == NcCounted::UpToComment) {
            length = std::min(text.find(';'), length);
        }
        if (length > flavour_.line_length) {
            fail("nc.long_line", "has " + std::to_string(length) +
                                     " characters; the controller reads at most " +
                                     std::to_string(flavour_.line_length));
        }
    }

    // The line without the words of letters alone that are known to be harmless.
    std::string_view without_words(std::string_view text) {
        std::size_t code = std::min(text.find(';'), text.size());
        kept_.clear();
        for (std::size_t i = 0; i < code;) {
            const std::size_t end = std::min(text.find_first_of(" \t", i), code);
            const std::string_view word = text.substr(i, end - i);
            kept_ += is_harmless(word) ? std::string() : std::string(word) + ' ';
            i = end + (end < code ? 1 : 0);
        }
        kept_ += text.substr(code);
        return kept_;
    }

    [[nodiscard]] bool is_harmless(std::string_view word) const {
        return std::any_of(
            flavour_.harmless_words.begin(), flavour_.harmless_words.end(),
            [&](std::string_view known) {
                const bool number = known.back() == '=';
                const std::string_view rest = word.substr(std::min(known.size(), word.size()));
                return word.substr(0, known.size()) == known &&
                       (number ? !rest.empty() && rest.find_first_not_of("0123456789.") == rest.npos
                               : rest.empty());
            });
    }

    void comments() {
        marks_.read(line_, list_);
        const auto& found = line_.comments;
        const std::string_view end = flavour_.end_comment;
        ended_ =
            ended_ || (!end.empty() && std::find(found.begin(), found.end(), end) != found.end());
    }

    // What the language asks of the text itself.
    void check_form(std::string_view text) {
        if (flavour_.one_command) {
            check_command(text.substr(0, text.find(';')));
        }
        for (const NcWord& word : line_.words) {
            const auto digits = std::count_if(word.number.begin(), word.number.end(),
                                              [](char c) { return c >= '0' && c <= '9'; });
            if (flavour_.most_digits > 0 && digits > static_cast<long>(flavour_.most_digits)) {
                fail("nc.digits", std::string("\"") + word.letter + std::string(word.number) +
                                      "\" has more than the " +
                                      std::to_string(flavour_.most_digits) +
                                      " digits that the controller reads");
            }
            const bool value = word.letter == 'F' || axis_of(word) >= 0;
            if (flavour_.needs_point && value && word.number.find('.') == std::string_view::npos) {
                fail("nc.number",
                     std::string("\"") + word.letter + std::string(word.number) +
                         "\" has no point and may mean thousandths; write it with one");
            }
        }
    }

    void check_command(std::string_view code) const {
        if (std::any_of(code.begin(), code.end(), [](char c) { return c >= 'a' && c <= 'z'; })) {
            fail("nc.not_understood", "the controller knows no small letters");
        }
        const auto is_command = [](const NcWord& w) { return w.letter == 'G' || w.letter == 'M'; };
        const auto& words = line_.words;
        const auto commands = std::count_if(words.begin(), words.end(), is_command);
        if (!words.empty() && (commands != 1 || !is_command(words.front()))) {
            fail(
                "nc.not_understood",
                "the controller runs one command a line, which stands in front; give each its own");
        }
        const bool takes_words = !words.empty() && (words.front().letter == 'M' ||
                                                    words.front().number.find_first_not_of("01") ==
                                                        std::string_view::npos);
        if (words.size() > 1 && !takes_words) {
            line_.not_understood(words[1]);
        }
    }

    [[nodiscard]] int axis_of(const NcWord& word) const {
        return axis_of_[static_cast<std::size_t>(word.letter - 'A')];
    }

    [[nodiscard]] double feed(const NcWord& word) const {
        double value = 0.0;
        const char* last = word.number.data() + word.number.size();
        const auto [end, error] =
            std::from_chars(word.number.data(), last, value, std::chars_format::fixed);
        if (error != std::errc{} || end != last || !(value > 0.0) || !std::isfinite(value)) {
            fail("nc.feed", "F" + std::string(word.number) + " is not above 0");
        }
        return value;
    }

    void execute() {
        feed_word_.reset();
        parameters_.clear();
        path_code_ = nullptr;
        stops_ = false;
        int motions = 0;
        for (const NcWord& word : line_.words) {
            if (word.letter == 'G') {
                const int number = line_.code(word);
                motions += number == 0 || number == 10 ? 1 : 0;
                g_code(number, word);
            } else if (word.letter == 'M') {
                m_code(word);
            }
        }
        bool axes = false;
        for (const NcWord& word : line_.words) {
            if (parameters_.find(word.letter) != std::string::npos || word.letter == 'N') {
                (void)line_.nano(word);
            } else if (word.letter == 'F') {
                feed_word_ = feed(word);
            } else if (axis_of(word) >= 0) {
                axes = true;
            } else if (word.letter != 'G' && word.letter != 'M') {
                no_such_word(word);
            }
        }
        if (motions > 1) {
            fail("nc.not_understood", "G0 and G1 in one line; keep one");
        }
        if (feed_word_ && !inverse_time_) {
            feed_per_minute_ = *feed_word_;
        }
        if (path_code_ != nullptr) {
            set_path_mode();
        }
        if (axes) {
            move();
        }
        if (stops_ && list_.blocks.empty()) {
            list_.head->stop_line = line_.number;
        }
    }

    [[noreturn]] void no_such_word(const NcWord& word) const {
        if (flavour_.letters.find(word.letter) == std::string_view::npos) {
            line_.not_understood(word);
        }
        fail("nc.no_axis", std::string("\"") + word.letter + std::string(word.number) +
                               "\" moves an axis that the machine \"" + machine_name_ +
                               "\" does not have; is it the machine of this program?");
    }

    // The code with its parameters, numbers as short as they can be.
    void set_path_mode() {
        PathMode mode;
        mode.words = "G" + std::to_string(path_code_->tenths / 10);
        mode.words +=
            path_code_->tenths % 10 == 0 ? "" : "." + std::to_string(path_code_->tenths % 10);
        for (const char letter : path_code_->parameters) {
            for (const NcWord& word : line_.words) {
                if (word.letter == letter) {
                    const double value =
                        static_cast<double>(line_.nano(word)) / static_cast<double>(kNanoPerUnit);
                    mode.words += std::string(" ") + letter;
                    append_shortest(mode.words, value);
                    mode.corner_mm = letter == 'P' && value > 0.0 ? value : mode.corner_mm;
                }
            }
        }
        std::vector<PathModeFrom>& modes = list_.head->path_modes;
        if (!modes.empty() && modes.back().block >= list_.blocks.size()) {
            modes.pop_back();  // nothing has run in it
        }
        if (path_mode().words != mode.words) {
            modes.push_back(
                {std::move(mode), std::max<std::size_t>(list_.blocks.size(), 1), line_.number});
        }
    }

    void g_code(int number, const NcWord& word) {
        const NcHarmless* known = harmless(flavour_.harmless_g, number);
        if (known != nullptr) {
            parameters_ += known->parameters;
            path_code_ = known->path ? known : path_code_;
        } else if (number == 0 || number == 10) {
            motion_ = number == 0 ? Motion::Rapid : Motion::Feed;
        } else if (number == 800 && flavour_.has_feed_modes) {
            motion_ = Motion::None;
        } else if (number == 900 || number == 910) {
            incremental_ = number == 910;
        } else if ((number == 930 || number == 940) && flavour_.has_feed_modes) {
            inverse_time_ = number == 930;
            feed_per_minute_ = 0.0;  // a change of mode asks for a fresh F
        } else {
            line_.not_understood(word);
        }
    }

    void m_code(const NcWord& word) {
        const int number = line_.code(word);
        const NcHarmless* known = harmless(flavour_.harmless_m, number);
        if (known != nullptr) {
            parameters_ += known->parameters;
        } else if ((number == 20 || number == 300) && !flavour_.end.empty()) {
            ended_ = true;
        } else if (number != 0 && number != 10) {
            line_.not_understood(word);
        }
        stops_ = stops_ || number == 0;
    }

    void move() {
        if (motion_ == Motion::None) {
            fail("nc.no_motion_mode", "axis words before any G0 or G1");
        }
        if (motion_ == Motion::Feed && list_.blocks.empty()) {
            start();
        }
        const std::vector<std::int64_t> before = position_;
        for (const NcWord& word : line_.words) {
            const int axis = axis_of(word);
            if (axis >= 0) {
                place(static_cast<std::size_t>(axis), word);
            }
        }
        if (motion_ == Motion::Rapid) {
            rapid();
            return;
        }
        if (!inverse_time_ && position_ == before) {
            return;  // no way, no time: nothing is run
        }
        list_.blocks.push_back(
            {.duration_s = duration_s(before), .piece = marks_.piece(), .line = line_.number});
        list_.nano.insert(list_.nano.end(), position_.begin(), position_.end());
    }

    void rapid() {
        if (!list_.blocks.empty()) {
            fail("nc.rapid", "a rapid move after the first feed move would tear the fibre");
        }
        any_placed_ = true;
        if (list_.head->approach.size() == kMostRapidMoves) {
            fail("nc.too_many_lines", "more than " + std::to_string(kMostRapidMoves) +
                                          " rapid moves lead to the start; leave some out");
        }
        RapidMove move{position_, placed_, std::vector<bool>(position_.size(), false),
                       line_.number};
        for (const NcWord& word : line_.words) {
            if (axis_of(word) >= 0) {
                move.named[static_cast<std::size_t>(axis_of(word))] = true;
            }
        }
        list_.head->approach.push_back(std::move(move));
        list_.head->stop_line = 0;
    }

    // The place where the first feed move begins is block 0.
    void start() {
        for (std::size_t a = 0; a < placed_.size(); ++a) {
            if (!placed_[a]) {
                fail("nc.unknown_start", std::string("axis ") + list_.axes[a].letter +
                                             " has no absolute position before the first feed "
                                             "move; place it with G90 G0");
            }
        }
        list_.blocks.push_back({.piece = marks_.piece(), .line = line_.number});
        list_.nano.insert(list_.nano.end(), position_.begin(), position_.end());
    }

    void place(std::size_t axis, const NcWord& word) {
        const std::int64_t value = line_.nano(word);
        const bool binary =
            flavour_.float32 != Float32Text::None && value % kFinestBinary_nano == 0;
        if (value % list_.axes[axis].resolution_nano != 0 && !binary) {
            fail("nc.resolution", std::string("\"") + word.letter + std::string(word.number) +
                                      "\" is not a multiple of the axis' resolution");
        }
        std::int64_t sum = value;
        if (incremental_ && __builtin_add_overflow(position_[axis], value, &sum)) {
            line_.bad_number(word);
        }
        if (const std::string words =
                beyond_one_block(list_.axes[axis], placed_[axis] ? position_[axis] : sum, sum);
            !words.empty()) {
            fail("nc.too_far", words);
        }
        position_[axis] = sum;
        placed_[axis] = placed_[axis] || !incremental_;
    }

    [[nodiscard]] double duration_s(const std::vector<std::int64_t>& before) const {
        if (inverse_time_) {
            if (!feed_word_) {
                fail("nc.feed", "a G93 feed move without F; write F in every line");
            }
            return kSecondsPerMinute / *feed_word_;
        }
        if (!(feed_per_minute_ > 0.0)) {
            fail("nc.feed", "a feed move before any F; write F");
        }
        return kSecondsPerMinute *
               feed_length(flavour_.feed_rule, move_lengths(list_.axes, before, position_)) /
               feed_per_minute_;
    }

    enum class Motion { None, Rapid, Feed };

    const NcFlavour& flavour_;
    const std::string file_;
    const std::string machine_name_;
    BlockList list_;
    std::array<int, 26> axis_of_{};
    std::vector<std::int64_t> position_;
    std::vector<bool> placed_;
    NcLine line_;
    Motion motion_ = Motion::None;
    bool incremental_ = false;
    bool inverse_time_ = false;
    bool ended_ = false;
    bool any_placed_ = false;
    double feed_per_minute_ = 0.0;
    std::optional<double> feed_word_;
    const NcHarmless* path_code_ = nullptr;  // of the line
    bool stops_ = false;                     // the line has M0
    std::string parameters_;                 // letters that belong to a harmless code of the line
    std::string kept_;                       // the line without harmless words
    NcMarks marks_;
};

}  // namespace

void check_own_line(const NcFlavour& flavour, const Machine& machine, const std::string& line) {
    std::string trouble;
    const auto plain = [](char c) { return c >= ' ' && c <= '~'; };
    if (!std::all_of(line.begin(), line.end(), plain)) {
        trouble = "it has characters that are not plain ASCII";
    } else if (line.find_first_not_of(" %") == std::string::npos && !line.empty() &&
               line.find('%') != std::string::npos) {
        trouble = "% begins or ends the program";
    } else {
        Reader reader(flavour, machine.name, machine);
        try {
            reader.line(line);
            trouble = reader.moved() ? "it moves, ends the program or ties the fibre on" : "";
        } catch (const InputError& error) {
            // The place is that of the line in no file.
            trouble = error.words();
        }
    }
    if (!trouble.empty()) {
        throw InputError("dialect.header_line", machine.name,
                         std::string("controller line \"")
                             .append(line)
                             .append("\" cannot be used: ")
                             .append(trouble));
    }
}

PathMode path_mode_of(const NcFlavour& flavour, const Machine& machine) {
    Reader reader(flavour, machine.name, machine);
    for (const std::string& line :
         filled_lines(machine.controller.header, LineValues{}, machine.name)) {
        try {
            reader.line(line);
        } catch (const InputError&) {
            // Said by check_own_line when it is written.
        }
    }
    return reader.path_mode();
}

BlockList read_nc(const NcFlavour& flavour, std::string_view text, const std::string& file,
                  const Machine& machine) {
    return Reader(flavour, file, machine).program(text);
}

}  // namespace meshwind
