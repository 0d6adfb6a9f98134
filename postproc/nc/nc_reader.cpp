#include "postproc/nc/nc_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/interrupt.h"
#include "postproc/nc/float32_steps.h"
#include "postproc/nc/foreign_notes.h"
#include "postproc/nc/header_lines.h"
#include "postproc/nc/nc_form.h"
#include "postproc/nc/nc_modes.h"

namespace meshwind {
namespace {

constexpr double kSecondsPerMinute = 60.0;

// A program needs two to get to its start; each that is kept takes some hundred bytes.
constexpr std::size_t kMaxRapidMoves = 1000;

// An inch is 25.4 mm.
constexpr std::int64_t kTenthsOfMmPerInch = 254;

// Lines are run between two looks at whether an end is asked for: some milliseconds.
constexpr std::int64_t kLinesPerLook = 4096;

// Where the axes are, by integers of 1e-9 mm or deg. Absolute words count from an origin,
// incremental ones from where the text has the axis.
class AxisPlaces {
public:
    explicit AxisPlaces(std::size_t axes)
        : nano_(axes, 0), exact_(axes, 0), origin_(axes, 0), placed_(axes, false) {}

    // On the axes' steps.
    [[nodiscard]] const std::vector<std::int64_t>& nano() const { return nano_; }

    // Whether an absolute word has said where an axis is.
    [[nodiscard]] const std::vector<bool>& placed() const { return placed_; }

    // The place that a word gives an axis; none where it is too far.
    [[nodiscard]] std::optional<std::int64_t> count(std::size_t axis, std::int64_t value,
                                                    bool incremental) {
        std::int64_t sum = value;
        if (__builtin_add_overflow(incremental ? exact_[axis] : origin_[axis], value, &sum)) {
            return {};
        }
        exact_[axis] = sum;
        return sum;
    }

    void go(std::size_t axis, std::int64_t nano, bool incremental) {
        nano_[axis] = nano;
        placed_[axis] = placed_[axis] || !incremental;
    }

    // The axis stands where it is, and its words count from elsewhere. False where that is too far.
    [[nodiscard]] bool set_origin(std::size_t axis, std::int64_t value) {
        const bool fits = !__builtin_sub_overflow(exact_[axis], value, &origin_[axis]);
        placed_[axis] = placed_[axis] || fits;
        return fits;
    }

    void clear_origins() { std::fill(origin_.begin(), origin_.end(), 0); }

private:
    std::vector<std::int64_t> nano_;
    std::vector<std::int64_t> exact_;   // as the text has it
    std::vector<std::int64_t> origin_;  // from which absolute words count
    std::vector<bool> placed_;
};

std::string end_words(const NcFlavour& flavour) {
    std::string end(flavour.end.substr(0, flavour.end.find('\n')));
    return end.empty() ? "\"; " + std::string(flavour.end_comment) + "\"" : end;
}

// Line after line in a language without calls and repeats.
ProgramFlow flow_of(const NcFlavour& flavour, const std::vector<std::string_view>& lines,
                    const std::string& file) {
    if (flavour.flow != nullptr) {
        return flavour.flow(lines, file);
    }
    ProgramFlow flow;
    flow.main.push_back({.first = 1, .last = static_cast<std::int32_t>(lines.size())});
    return flow;
}

[[noreturn]] void no_such_word(const NcFlavour& flavour, const Machine& machine, const NcLine& line,
                               const NcWord& word) {
    if (flavour.letters.find(word.letter) == std::string_view::npos) {
        line.not_understood(word);
    }
    line.fail("nc.no_axis", std::string("\"") + word.letter + std::string(word.number) +
                                "\" moves an axis that the machine \"" + machine.name +
                                "\" does not have; is it the machine of this program?");
}

// A word of an axis in nano units of the machine.
std::int64_t axis_value(const NcLine& line, const NcWord& word, const BlockAxis& axis,
                        bool inches) {
    std::int64_t value = line.nano(word);
    if (inches && axis.type == AxisType::Linear) {
        if (__builtin_mul_overflow(value, kTenthsOfMmPerInch, &value)) {
            line.bad_number(word);
        }
        value /= 10;
    }
    return value;
}

// From a position to the axis' nearest step.
std::int64_t to_nearest_step(std::int64_t exact, std::int64_t step) {
    const std::int64_t left = exact % step;
    if (left == 0) {
        return 0;
    }
    return std::abs(left) * 2 <= step ? -left : (left < 0 ? -step : step) - left;
}

// Reads a program line by line into blocks.
class Reader {
public:
    Reader(const NcFlavour& flavour, std::string file, const Machine& machine);

    [[nodiscard]] BlockList program(std::string_view text) &&;
    void line(std::string_view text);

    // Of lines that were read.
    [[nodiscard]] PathMode path_mode() const;
    [[nodiscard]] bool moved() const {
        return !list_.blocks.empty() || any_placed_ || modes_.ended || list_.tie_on_mm.has_value();
    }

private:
    void comments();
    void execute();
    void take_words(NcSaid& said);
    void change_path_mode(PathMode mode);

    void set_origins();
    void place(std::size_t axis, const NcWord& word);
    void move(const NcSaid& said);
    void rapid();
    void start();
    void append_block(double duration_s);
    [[nodiscard]] bool winds_rapidly() const;
    [[nodiscard]] double duration_s(const NcSaid& said, const std::vector<std::int64_t>& before);

    [[nodiscard]] int axis_of(const NcWord& word) const {
        return axis_of_[static_cast<std::size_t>(word.letter - 'A')];
    }

    const NcFlavour& flavour_;
    const std::string file_;
    const Machine& machine_;
    std::array<int, 26> axis_of_{};
    std::string axis_letters_;
    ProgramOrigin from_{.by_meshwind = true};  // of lines outside a program
    // A line of the controller's own is read as if it were ours.
    NcLanguage language_{flavour_};
    NcLine line_;
    std::string kept_;  // the line without harmless words
    NcMarks marks_;
    NcModes modes_;
    AxisPlaces places_;
    bool any_placed_ = false;
    bool stop_seen_ = false;  // a line before had M0
    ForeignNotes notes_;
    BlockList list_;
};

Reader::Reader(const NcFlavour& flavour, std::string file, const Machine& machine)
    : flavour_(flavour), file_(std::move(file)), machine_(machine), places_(machine.axis_count()) {
    line_.file = &file_;
    line_.style = flavour.comments;
    axis_of_.fill(-1);
    for (std::size_t a = 0; a < machine.axis_count(); ++a) {
        const Axis& axis = machine.axis(a);
        list_.axes.push_back({axis.letter, axis.type, axis.resolution_nano});
        axis_of_[static_cast<std::size_t>(axis.letter - 'A')] = static_cast<int>(a);
        axis_letters_ += axis.letter;
    }
    list_.head.emplace().has_approach = true;
}

BlockList Reader::program(std::string_view text) && {
    const std::vector<std::string_view> lines = lines_of_text(text);
    from_ = origin_of(flavour_.comments, lines);
    list_.head->by_meshwind = from_.by_meshwind;
    language_.foreign = !from_.by_meshwind;
    line_.drops_digits = language_.foreign;
    std::int64_t run = 0;
    run_flow(flow_of(flavour_, lines, file_), file_, [&](std::int32_t number, FlowLine kind) {
        if (++run % kLinesPerLook == 0) {
            check_interrupt();
        }
        line_.number = number;
        const std::string_view words = lines[static_cast<std::size_t>(number) - 1];
        if (kind == FlowLine::Code) {
            line(words);
        } else {
            check_length(flavour_, language_.foreign, words, line_);
            (void)line_.split_comments(words);
            comments();
        }
        return !modes_.ended || flavour_.runs_on;
    });
    if (!modes_.ended && language_.foreign && moved()) {
        notes_.no_end(end_words(flavour_));
    } else if (!modes_.ended) {
        line_.fail("nc.no_end",
                   "the program has no " + end_words(flavour_) + "; the file may be cut off");
    }
    if (list_.blocks.size() < 2) {
        line_.fail("nc.no_motion", "the program has no feed move; there is nothing to wind");
    }
    if (flavour_.float32 != Float32Text::None) {
        set_binary_steps(list_);
    }
    list_.head->remarks = notes_.words(!from_.feeds);
    return std::move(list_);
}

void Reader::line(std::string_view text) {
    check_length(flavour_, language_.foreign, text, line_);
    if (text == "%" && flavour_.flow != nullptr) {
        modes_.ended = list_.blocks.empty() ? modes_.ended : true;
        return;
    }
    if (flavour_.harmless_words.empty()) {
        line_.split(text);
    } else {
        kept_ = without_harmless_words(flavour_, text);
        line_.split(kept_);
    }
    if (modes_.ended && flavour_.runs_on && !line_.words.empty()) {
        line_.fail("nc.not_understood", "code behind the end would be run; remove it");
    }
    comments();
    check_form(flavour_, language_.foreign, text, line_, axis_letters_);
    execute();
}

PathMode Reader::path_mode() const {
    const std::vector<PathModeFrom>& modes = list_.head->path_modes;
    return modes.empty() ? PathMode{} : modes.back().mode;
}

void Reader::comments() {
    marks_.read(line_, list_);
    const auto& found = line_.comments;
    const std::string_view end = flavour_.end_comment;
    modes_.ended =
        modes_.ended || (!end.empty() && std::find(found.begin(), found.end(), end) != found.end());
}

void Reader::execute() {
    NcSaid said = take_codes(language_, line_, modes_, notes_);
    take_words(said);
    if (said.motions > 1) {
        line_.fail("nc.not_understood", "G0 and G1 in one line; keep one");
    }
    if (said.feed && !modes_.inverse_time) {
        modes_.feed_per_minute = *said.feed;
        modes_.feed_in_inches = modes_.inches;
    }
    if (said.path_code != nullptr) {
        change_path_mode(asked_path_mode(*said.path_code, line_));
    }
    if (said.clears_place) {
        places_.clear_origins();
    }
    if (said.sets_place) {
        set_origins();
    } else if (said.axes && !(said.idles && said.motions == 0)) {
        move(said);
    }
    if (said.stops && list_.blocks.empty()) {
        list_.head->stop_line = line_.number;
    }
    stop_seen_ = stop_seen_ || said.stops;
}

// The words that are no codes. Those of axes are only looked for.
void Reader::take_words(NcSaid& said) {
    for (const NcWord& word : line_.words) {
        if (said.parameters.find(word.letter) != std::string::npos || word.letter == 'N') {
            (void)line_.nano(word);
        } else if (word.letter == 'F' && !said.idles) {
            said.feed = line_.feed(word);
        } else if (axis_of(word) >= 0) {
            said.axes = true;
        } else if (language_.foreign && is_idle_letter(word.letter)) {
            notes_.skipped(word);
        } else if (word.letter != 'G' && word.letter != 'M' && word.letter != 'F') {
            no_such_word(flavour_, machine_, line_, word);
        }
    }
}

void Reader::change_path_mode(PathMode mode) {
    std::vector<PathModeFrom>& modes = list_.head->path_modes;
    if (!modes.empty() && modes.back().block >= list_.blocks.size()) {
        modes.pop_back();  // nothing has run in it
    }
    if (path_mode().words != mode.words) {
        modes.push_back(
            {std::move(mode), std::max<std::size_t>(list_.blocks.size(), 1), line_.number});
    }
}

// G92: the axes stand where they are, and their words count from elsewhere.
void Reader::set_origins() {
    notes_.set_place(line_.number);
    for (const NcWord& word : line_.words) {
        const int found = axis_of(word);
        if (found >= 0) {
            const auto axis = static_cast<std::size_t>(found);
            if (!places_.set_origin(axis,
                                    axis_value(line_, word, list_.axes[axis], modes_.inches))) {
                line_.bad_number(word);
            }
        }
    }
}

void Reader::place(std::size_t axis, const NcWord& word) {
    const BlockAxis& of = list_.axes[axis];
    const std::int64_t value = axis_value(line_, word, of, modes_.inches);
    check_step(flavour_, language_.foreign, line_, word, of, value);
    const std::optional<std::int64_t> exact = places_.count(axis, value, modes_.incremental);
    if (!exact) {
        line_.bad_number(word);
    }
    std::int64_t nano = *exact;
    const std::int64_t off = language_.foreign ? to_nearest_step(nano, of.resolution_nano) : 0;
    if (off != 0) {
        notes_.rounded(of, off);
        if (__builtin_add_overflow(nano, off, &nano)) {
            line_.bad_number(word);
        }
    }
    const std::int64_t from = places_.placed()[axis] ? places_.nano()[axis] : nano;
    if (const std::string words = beyond_one_block(of, from, nano); !words.empty()) {
        line_.fail("nc.too_far", words);
    }
    places_.go(axis, nano, modes_.incremental);
}

void Reader::move(const NcSaid& said) {
    if (modes_.motion == NcMotion::None) {
        line_.fail("nc.no_motion_mode", "axis words before any G0 or G1");
    }
    const bool feeds = modes_.motion == NcMotion::Feed || winds_rapidly();
    if (feeds && list_.blocks.empty()) {
        start();
    }
    const std::vector<std::int64_t> before = places_.nano();
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
    if ((!modes_.inverse_time || modes_.motion == NcMotion::Rapid) && places_.nano() == before) {
        return;  // no way, no time: nothing is run
    }
    append_block(duration_s(said, before));
}

// Whether a rapid move of others has the fibre on: behind a feed move, or where there is none
// behind the stop for the tie-on, or without one behind the move to the start.
bool Reader::winds_rapidly() const {
    if (modes_.motion != NcMotion::Rapid || !language_.foreign) {
        return false;
    }
    const bool started = from_.stops ? stop_seen_ : !list_.head->approach.empty();
    return !list_.blocks.empty() || (!from_.feeds && started);
}

void Reader::rapid() {
    if (!list_.blocks.empty()) {
        line_.fail("nc.rapid", "a rapid move after the first feed move would tear the fibre");
    }
    any_placed_ = true;
    if (list_.head->approach.size() == kMaxRapidMoves) {
        line_.fail("nc.too_many_lines", "more than " + std::to_string(kMaxRapidMoves) +
                                            " rapid moves lead to the start; leave some out");
    }
    RapidMove move{places_.nano(), places_.placed(), std::vector<bool>(list_.axes.size(), false),
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
void Reader::start() {
    for (std::size_t a = 0; a < list_.axes.size(); ++a) {
        if (!places_.placed()[a] && language_.foreign) {
            notes_.unplaced(list_.axes[a].letter, line_.number);
        } else if (!places_.placed()[a]) {
            line_.fail("nc.unknown_start", std::string("axis ") + list_.axes[a].letter +
                                               " has no absolute position before the first feed "
                                               "move; place it with G90 G0");
        }
    }
    append_block(0.0);
}

void Reader::append_block(double duration_s) {
    list_.blocks.push_back(
        {.duration_s = duration_s, .piece = marks_.piece(), .line = line_.number});
    list_.nano.insert(list_.nano.end(), places_.nano().begin(), places_.nano().end());
}

double Reader::duration_s(const NcSaid& said, const std::vector<std::int64_t>& before) {
    if (modes_.motion == NcMotion::Rapid) {
        notes_.rapid_with_fibre(flavour_.rapid_by_feed, line_.number);
        if (!flavour_.rapid_by_feed) {
            return rapid_time_s(machine_, before, places_.nano());
        }
    }
    if (modes_.inverse_time) {
        if (!said.feed) {
            line_.fail("nc.feed", "a G93 feed move without F; write F in every line");
        }
        return kSecondsPerMinute / *said.feed;
    }
    if (!(modes_.feed_per_minute > 0.0)) {
        line_.fail("nc.feed", "a feed move before any F; write F");
    }
    const MoveLengths way = move_lengths(list_.axes, before, places_.nano());
    const double per_minute = modes_.feed_in_inches && way.linear() > 0.0
                                  ? kTenthsOfMmPerInch * modes_.feed_per_minute / 10.0
                                  : modes_.feed_per_minute;
    return kSecondsPerMinute * feed_length(flavour_.feed_rule, way) / per_minute;
}

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
