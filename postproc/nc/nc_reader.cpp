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
#include "core/units.h"
#include "postproc/nc/float32_steps.h"
#include "postproc/nc/foreign_notes.h"
#include "postproc/nc/header_lines.h"
#include "postproc/nc/nc_form.h"

namespace meshwind {
namespace {

constexpr double kSecondsPerMinute = 60.0;

// A program needs two to get to its start; each that is kept takes some hundred bytes.
constexpr std::size_t kMostRapidMoves = 1000;

// An inch is 25.4 mm.
constexpr std::int64_t kTenthsOfMmPerInch = 254;

// Words of others that say nothing of axes, where no axis has their letter: tools, spindles,
// parameters of M words.
constexpr std::string_view kIdleWords = "DHKLOPQRST";

// Codes of others that move no axis, in tenths: a pause, look-ahead, planes, mm, offsets and cycles
// off, the workpiece's zero, which is the operator's, words on corners.
constexpr int kPause = 40;
constexpr std::array kIdleG = {kPause, 80,  90,  170, 180, 190, 210, 400, 490, 540,
                               550,    560, 570, 580, 590, 610, 640, 710, 800};

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
        : flavour_(flavour), file_(std::move(file)), machine_(machine) {
        line_.file = &file_;
        line_.style = flavour.comments;
        axis_of_.fill(-1);
        for (std::size_t a = 0; a < machine.axis_count(); ++a) {
            const Axis& axis = machine.axis(a);
            list_.axes.push_back({axis.letter, axis.type, axis.resolution_nano});
            axis_of_[static_cast<std::size_t>(axis.letter - 'A')] = static_cast<int>(a);
            axis_letters_ += axis.letter;
        }
        position_.assign(list_.axes.size(), 0);
        exact_.assign(list_.axes.size(), 0);
        origin_.assign(list_.axes.size(), 0);
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
        from_ = origin_of(flavour_.comments, lines);
        list_.head->by_meshwind = from_.by_meshwind;
        line_.drops_digits = is_foreign();
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
                check_length(flavour_, is_foreign(), words, line_);
                (void)line_.split_comments(words);
                comments();
            }
            return !ended_ || flavour_.runs_on;
        });
        if (!ended_ && is_foreign() && moved()) {
            notes_.no_end(end_words());
        } else if (!ended_) {
            fail("nc.no_end", "the program has no " + end_words() + "; the file may be cut off");
        }
        if (list_.blocks.size() < 2) {
            fail("nc.no_motion", "the program has no feed move; there is nothing to wind");
        }
        if (flavour_.float32 != Float32Text::None) {
            set_binary_steps(list_);
        }
        list_.head->remarks = notes_.words(!from_.feeds);
        return std::move(list_);
    }

    void line(std::string_view text) {
        check_length(flavour_, is_foreign(), text, line_);
        if (text == "%" && flavour_.flow != nullptr) {
            ended_ = list_.blocks.empty() ? ended_ : true;
            return;
        }
        if (flavour_.harmless_words.empty()) {
            line_.split(text);
        } else {
            kept_ = without_harmless_words(flavour_, text);
            line_.split(kept_);
        }
        if (ended_ && flavour_.runs_on && !line_.words.empty()) {
            fail("nc.not_understood", "code behind the end would be run; remove it");
        }
        comments();
        check_form(flavour_, is_foreign(), text, line_, axis_letters_);
        execute();
    }

    [[nodiscard]] bool moved() const {
        return !list_.blocks.empty() || any_placed_ || ended_ || list_.tie_on_mm.has_value();
    }

private:
    // A line of the controller's own is read as if it were ours.
    [[nodiscard]] bool is_foreign() const { return !from_.by_meshwind; }

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

    void comments() {
        marks_.read(line_, list_);
        const auto& found = line_.comments;
        const std::string_view end = flavour_.end_comment;
        ended_ =
            ended_ || (!end.empty() && std::find(found.begin(), found.end(), end) != found.end());
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
        idles_ = false;
        sets_place_ = false;
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
            } else if (word.letter == 'F' && !idles_) {
                feed_word_ = feed(word);
            } else if (axis_of(word) >= 0) {
                axes = true;
            } else if (is_foreign() && kIdleWords.find(word.letter) != std::string_view::npos) {
                notes_.skipped(word);
            } else if (word.letter != 'G' && word.letter != 'M' && word.letter != 'F') {
                no_such_word(word);
            }
        }
        if (motions > 1) {
            fail("nc.not_understood", "G0 and G1 in one line; keep one");
        }
        if (feed_word_ && !inverse_time_) {
            feed_per_minute_ = *feed_word_;
            feed_in_inches_ = inches_;
        }
        if (path_code_ != nullptr) {
            set_path_mode();
        }
        if (sets_place_) {
            set_place();
        } else if (axes && !(idles_ && motions == 0)) {
            move();
        }
        if (stops_ && list_.blocks.empty()) {
            list_.head->stop_line = line_.number;
        }
        stop_seen_ = stop_seen_ || stops_;
    }

    [[noreturn]] void no_such_word(const NcWord& word) const {
        if (flavour_.letters.find(word.letter) == std::string_view::npos) {
            line_.not_understood(word);
        }
        fail("nc.no_axis", std::string("\"") + word.letter + std::string(word.number) +
                               "\" moves an axis that the machine \"" + machine_.name +
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
        inches_ = inches_ && number != 210 && number != 710;
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
        } else if (!is_foreign() || !foreign_g_code(number, word)) {
            line_.not_understood(word);
        }
    }

    // Of a program of others: codes that say where an axis stands, units, and what moves no axis.
    [[nodiscard]] bool foreign_g_code(int number, const NcWord& word) {
        if (number == 920) {
            sets_place_ = true;
        } else if (number == 921) {
            notes_.set_place(line_.number);
            std::fill(origin_.begin(), origin_.end(), 0);
        } else if (number == 200 || number == 700) {
            inches_ = true;
            notes_.inches(line_.number);
        } else if (std::find(kIdleG.begin(), kIdleG.end(), number) != kIdleG.end()) {
            idles_ = idles_ || number == kPause;
            notes_.skipped(word);
        } else {
            return false;
        }
        return true;
    }

    // All but calls of subprograms and their ends, and M47, which starts again.
    [[nodiscard]] static bool is_idle_m(int tenths) {
        return tenths != 470 && (tenths < 960 || tenths > 999);
    }

    void m_code(const NcWord& word) {
        const int number = line_.code(word);
        const NcHarmless* known = harmless(flavour_.harmless_m, number);
        if (known != nullptr) {
            parameters_ += known->parameters;
        } else if ((number == 20 || number == 300) && !flavour_.end.empty()) {
            ended_ = true;
        } else if (number != 0 && number != 10 && is_foreign() && is_idle_m(number)) {
            idles_ = idles_ || flavour_.one_command;
            notes_.skipped(word);
        } else if (number != 0 && number != 10) {
            line_.not_understood(word);
        }
        stops_ = stops_ || number == 0;
    }

    void move() {
        if (motion_ == Motion::None) {
            fail("nc.no_motion_mode", "axis words before any G0 or G1");
        }
        const bool feeds = motion_ == Motion::Feed || winds_rapidly();
        if (feeds && list_.blocks.empty()) {
            start();
        }
        const std::vector<std::int64_t> before = position_;
        for (const NcWord& word : line_.words) {
            const int axis = axis_of(word);
            if (axis >= 0) {
                place(static_cast<std::size_t>(axis), word);
            }
        }
        if (!feeds) {
            rapid();
            return;
        }
        if ((!inverse_time_ || motion_ == Motion::Rapid) && position_ == before) {
            return;  // no way, no time: nothing is run
        }
        list_.blocks.push_back(
            {.duration_s = duration_s(before), .piece = marks_.piece(), .line = line_.number});
        list_.nano.insert(list_.nano.end(), position_.begin(), position_.end());
    }

    // Whether a rapid move of others has the fibre on: behind a feed move, or where there is none
    // behind the stop for the tie-on, or without one behind the move to the start.
    [[nodiscard]] bool winds_rapidly() const {
        if (motion_ != Motion::Rapid || !is_foreign()) {
            return false;
        }
        const bool started = from_.stops ? stop_seen_ : !list_.head->approach.empty();
        return !list_.blocks.empty() || (!from_.feeds && started);
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
            if (!placed_[a] && is_foreign()) {
                notes_.unplaced(list_.axes[a].letter, line_.number);
            } else if (!placed_[a]) {
                fail("nc.unknown_start", std::string("axis ") + list_.axes[a].letter +
                                             " has no absolute position before the first feed "
                                             "move; place it with G90 G0");
            }
        }
        list_.blocks.push_back({.piece = marks_.piece(), .line = line_.number});
        list_.nano.insert(list_.nano.end(), position_.begin(), position_.end());
    }

    void place(std::size_t axis, const NcWord& word) {
        const std::int64_t value = axis_value(axis, word);
        const std::int64_t step = list_.axes[axis].resolution_nano;
        const bool binary =
            flavour_.float32 != Float32Text::None && value % kFinestBinary_nano == 0;
        if (value % step != 0 && !binary && !is_foreign()) {
            fail("nc.resolution", std::string("\"") + word.letter + std::string(word.number) +
                                      "\" is not a multiple of the axis' resolution");
        }
        std::int64_t sum = value;
        if (__builtin_add_overflow(incremental_ ? exact_[axis] : origin_[axis], value, &sum)) {
            line_.bad_number(word);
        }
        exact_[axis] = sum;
        if (is_foreign()) {
            sum = nearest_step(axis, sum, word);
        }
        if (const std::string words =
                beyond_one_block(list_.axes[axis], placed_[axis] ? position_[axis] : sum, sum);
            !words.empty()) {
            fail("nc.too_far", words);
        }
        position_[axis] = sum;
        placed_[axis] = placed_[axis] || !incremental_;
    }

    // A word of an axis in nano units of the machine.
    [[nodiscard]] std::int64_t axis_value(std::size_t axis, const NcWord& word) const {
        std::int64_t value = line_.nano(word);
        if (inches_ && list_.axes[axis].type == AxisType::Linear) {
            if (__builtin_mul_overflow(value, kTenthsOfMmPerInch, &value)) {
                line_.bad_number(word);
            }
            value /= 10;
        }
        return value;
    }

    [[nodiscard]] std::int64_t nearest_step(std::size_t axis, std::int64_t exact,
                                            const NcWord& word) {
        const std::int64_t step = list_.axes[axis].resolution_nano;
        const std::int64_t left = exact % step;
        if (left == 0) {
            return exact;
        }
        const std::int64_t off =
            std::abs(left) * 2 <= step ? -left : (left < 0 ? -step : step) - left;
        notes_.rounded(list_.axes[axis], off);
        std::int64_t rounded = 0;
        if (__builtin_add_overflow(exact, off, &rounded)) {
            line_.bad_number(word);
        }
        return rounded;
    }

    // G92: the axes stand where they are, and their words count from elsewhere.
    void set_place() {
        notes_.set_place(line_.number);
        for (const NcWord& word : line_.words) {
            const int found = axis_of(word);
            if (found >= 0) {
                const auto axis = static_cast<std::size_t>(found);
                if (__builtin_sub_overflow(exact_[axis], axis_value(axis, word), &origin_[axis])) {
                    line_.bad_number(word);
                }
                placed_[axis] = true;
            }
        }
    }

    // As fast as the slowest of the axes can, without ramps.
    [[nodiscard]] double rapid_s(const std::vector<std::int64_t>& before) const {
        double longest_s = 0.0;
        for (std::size_t a = 0; a < before.size(); ++a) {
            const double way = std::abs(static_cast<double>(position_[a] - before[a])) /
                               static_cast<double>(kNanoPerUnit);
            const bool rotary = list_.axes[a].type == AxisType::Rotary;
            longest_s =
                std::max(longest_s, (rotary ? rad_from_deg(way) : way) / machine_.axis(a).velocity);
        }
        return longest_s;
    }

    [[nodiscard]] double duration_s(const std::vector<std::int64_t>& before) {
        if (motion_ == Motion::Rapid) {
            notes_.rapid_with_fibre(flavour_.rapid_by_feed, line_.number);
            if (!flavour_.rapid_by_feed) {
                return rapid_s(before);
            }
        }
        if (inverse_time_) {
            if (!feed_word_) {
                fail("nc.feed", "a G93 feed move without F; write F in every line");
            }
            return kSecondsPerMinute / *feed_word_;
        }
        if (!(feed_per_minute_ > 0.0)) {
            fail("nc.feed", "a feed move before any F; write F");
        }
        const MoveLengths way = move_lengths(list_.axes, before, position_);
        const double per_minute = feed_in_inches_ && way.linear() > 0.0
                                      ? kTenthsOfMmPerInch * feed_per_minute_ / 10.0
                                      : feed_per_minute_;
        return kSecondsPerMinute * feed_length(flavour_.feed_rule, way) / per_minute;
    }

    enum class Motion { None, Rapid, Feed };

    const NcFlavour& flavour_;
    const std::string file_;
    const Machine& machine_;
    BlockList list_;
    std::array<int, 26> axis_of_{};
    ProgramOrigin from_{.by_meshwind = true};  // of lines outside a program
    ForeignNotes notes_;
    std::vector<std::int64_t> position_;  // on the axes' steps
    std::vector<std::int64_t> exact_;     // as the text has it
    std::vector<std::int64_t> origin_;    // from which absolute words count
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
    bool stop_seen_ = false;                 // a line before had
    bool idles_ = false;                     // the line has a pause, or an M word that is left out
    bool sets_place_ = false;                // it has G92
    bool inches_ = false;
    bool feed_in_inches_ = false;
    std::string parameters_;  // letters that belong to a harmless code of the line
    std::string kept_;        // the line without harmless words
    std::string axis_letters_;
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
