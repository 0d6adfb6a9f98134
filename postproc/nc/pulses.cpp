#include "postproc/nc/pulses.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/error.h"
#include "core/text/decimal_text.h"
#include "core/text/text_number.h"
#include "postproc/nc/foreign_notes.h"
#include "postproc/nc/nc_reader.h"
#include "postproc/nc/nc_writer.h"
#include "postproc/nc/program_flow.h"

namespace meshwind {
namespace {

// A duration that is a whole number of ticks up to rounding is not one tick more.
constexpr double kWholeTick = 1e-6;

NcFlavour text_flavour() {
    NcFlavour flavour;
    flavour.comments = NcComments::Semicolon;
    flavour.line_length = 200;
    return flavour;
}

std::int64_t ticks_of(double duration_s) {
    const double ticks = std::ceil(duration_s / kPulseTick_s - kWholeTick);
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(ticks));
}

// Steps done after `tick` of `ticks` when `steps` are to be done evenly; halves go away from zero.
std::int64_t done(std::int64_t steps, std::int64_t tick, std::int64_t ticks) {
    const std::int64_t rest = steps % ticks * tick;
    const std::int64_t half = rest < 0 ? -ticks : ticks;
    return steps / ticks * tick + (2 * rest + half) / (2 * ticks);
}

// Whether `sum` is within half a step of that.
bool is_even(std::int64_t sum, std::int64_t steps, std::int64_t tick, std::int64_t ticks) {
    const std::int64_t beyond = sum - steps / ticks * tick;
    return std::abs(beyond) <= ticks + 1 &&
           std::abs(2 * (beyond * ticks - steps % ticks * tick)) <= ticks;
}

// Replaces words by those of a line up to where its comment begins.
void split_until(std::string_view text, std::size_t end, std::vector<std::string_view>& words) {
    words.clear();
    for (std::size_t i = 0; i < end;) {
        const std::size_t stop = std::min(text.find(' ', i), end);
        if (stop > i) {
            words.push_back(text.substr(i, stop - i));
        }
        i = stop + 1;
    }
}

[[noreturn]] void wrong(const NcLine& line, const std::string& expected) {
    line.fail("nc.pulses", "this line does not fit; expected is " + expected);
}

void expect(const NcLine& line, bool fits, const char* expected) {
    if (!fits) {
        wrong(line, expected);
    }
}

// Sums over kMaxLinesRun ticks must fit.
constexpr std::int64_t kMaxPulses = 1'000'000'000;

std::int64_t whole(const NcLine& line, std::string_view word) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || std::abs(value) > kMaxPulses) {
        wrong(line, "whole numbers");
    }
    return value;
}

// The axis of each column.
std::vector<std::size_t> axis_order(const NcLine& line, const std::vector<BlockAxis>& axes,
                                    const std::vector<std::string_view>& words) {
    std::vector<std::size_t> order;
    for (const std::string_view word : words) {
        const auto axis = std::find_if(axes.begin(), axes.end(), [&](const BlockAxis& a) {
            return word.size() == 1 && a.letter == word.front();
        });
        const auto index = static_cast<std::size_t>(axis - axes.begin());
        if (axis == axes.end() || std::find(order.begin(), order.end(), index) != order.end()) {
            wrong(line, "each letter of the machine's axes once");
        }
        order.push_back(index);
    }
    if (order.size() != axes.size()) {
        wrong(line, "each letter of the machine's axes once");
    }
    return order;
}

// What a line says of each axis.
// \param order the axis of each column
// \return in the machine's order
std::vector<std::int64_t> axis_numbers(const NcLine& line, const std::vector<BlockAxis>& axes,
                                       const std::vector<std::size_t>& order,
                                       const std::vector<std::string_view>& words) {
    if (words.size() != order.size()) {
        wrong(line, "a number for each axis");
    }
    std::vector<std::int64_t> values(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        values[order[i]] = line.nano({axes[order[i]].letter, words[i]});
    }
    return values;
}

void check_step(const NcLine& line, const BlockAxis& axis, std::int64_t step_nano) {
    if (step_nano <= 0 || step_nano % axis.resolution_nano != 0) {
        line.fail("nc.resolution", std::string("the step of ") + axis.letter +
                                       " is not a multiple of the axis' resolution");
    }
}

void check_start(const NcLine& line, const BlockAxis& axis, std::int64_t nano) {
    if (nano % axis.resolution_nano != 0) {
        line.fail("nc.resolution", std::string("the start of ") + axis.letter +
                                       " is not a multiple of the axis' resolution");
    }
}

// A block whose ticks are being read.
struct OpenBlock {
    std::int64_t ticks = 0;
    std::int64_t left = 0;             // of these
    std::vector<std::int64_t> sum{};   // pulses of each axis
    std::vector<std::int64_t> sums{};  // the same at each tick
};

void check_even(const NcLine& line, const OpenBlock& block, const BlockAxis& axis,
                std::size_t index) {
    const std::size_t axes = block.sum.size();
    for (std::int64_t k = 0; k < block.ticks; ++k) {
        const std::int64_t sum = block.sums[static_cast<std::size_t>(k) * axes + index];
        if (!is_even(sum, block.sum[index], k + 1, block.ticks)) {
            line.fail("nc.pulses", std::string("the ticks of ") + axis.letter +
                                       " in the block that ends here are more than half a step "
                                       "off an even move; close the block where its speed changes");
        }
    }
}

// Where an axis is at the end of a block.
std::int64_t place_after(const NcLine& line, const BlockAxis& axis, std::int64_t before,
                         std::int64_t pulses, std::int64_t step_nano) {
    std::int64_t move = 0;
    std::int64_t place = 0;
    if (__builtin_mul_overflow(pulses, step_nano, &move) ||
        __builtin_add_overflow(before, move, &place)) {
        wrong(line, "a position within 9e9 mm or deg");
    }
    if (const std::string words = beyond_one_block(axis, before, place); !words.empty()) {
        line.fail("nc.too_far", words);
    }
    return place;
}

// Reads a program line by line into blocks.
class Reader {
public:
    Reader(const std::string& file, const Machine& machine);

    [[nodiscard]] BlockList program(std::string_view text) &&;

    // A line of the controller's own.
    void comment_only(std::string_view text);

private:
    void line(std::string_view text);
    void split(std::string_view text);
    void head_line(std::string_view key);
    void start();
    void open_block();
    void tick();
    void close_block();

    [[nodiscard]] std::vector<std::int64_t> numbers() const {
        return axis_numbers(line_, list_.axes, order_, words_);
    }

    NcLine line_;
    NcMarks marks_;
    BlockList list_;
    std::vector<std::string_view> words_;
    std::vector<std::size_t> order_;  // of the columns
    std::vector<std::int64_t> step_nano_;
    std::int64_t tick_nano_ = 0;
    OpenBlock block_;
    bool ended_ = false;
};

Reader::Reader(const std::string& file, const Machine& machine) {
    line_.file = &file;
    line_.style = NcComments::Semicolon;
    for (std::size_t a = 0; a < machine.axis_count(); ++a) {
        const Axis& axis = machine.axis(a);
        list_.axes.push_back({axis.letter, axis.type, axis.resolution_nano});
    }
    list_.head.emplace();
}

BlockList Reader::program(std::string_view text) && {
    const std::vector<std::string_view> lines = lines_of_text(text);
    list_.head->by_meshwind = is_by_meshwind(lines);
    for (const std::string_view words : lines) {
        ++line_.number;
        if (line_.number > kMaxLinesRun) {
            line_.fail("nc.too_many_lines", "more than " + std::to_string(kMaxLinesRun) +
                                                " lines are not read; split the program");
        }
        line(words);
    }
    if (!ended_) {
        line_.fail("nc.no_end", "the program has no line \"end\"; the file may be cut off");
    }
    if (list_.blocks.size() < 2) {
        line_.fail("nc.no_motion", "the program has no block; there is nothing to wind");
    }
    return std::move(list_);
}

void Reader::comment_only(std::string_view text) {
    line(text);
    if (!words_.empty() || list_.tie_on_mm) {
        wrong(line_, "only comments that tie nothing on");
    }
}

void Reader::line(std::string_view text) {
    split(text);
    if (words_.empty()) {
        return;
    }
    if (ended_) {
        wrong(line_, "nothing behind \"end\"");
    }
    if (block_.left > 0) {
        tick();
        return;
    }
    const std::string_view key = words_.front();
    words_.erase(words_.begin());
    if (list_.blocks.empty()) {
        head_line(key);
    } else if (key == "end" && words_.empty()) {
        ended_ = true;
    } else {
        expect(line_, key == "block" && words_.size() == 1, "block and its ticks, or end");
        open_block();
    }
}

void Reader::split(std::string_view text) {
    line_.comments.clear();
    const std::size_t end = std::min(text.find(';'), text.size());
    if (end < text.size()) {
        const std::size_t blank = text.substr(end + 1, 1) == " " ? 1 : 0;
        line_.comments.push_back(text.substr(end + 1 + blank));
        marks_.read(line_, list_);
    }
    split_until(text, end, words_);
}

// The lines before the blocks, in their order.
void Reader::head_line(std::string_view key) {
    if (order_.empty()) {
        expect(line_, key == "axes", "axes and their letters");
        order_ = axis_order(line_, list_.axes, words_);
    } else if (step_nano_.empty()) {
        expect(line_, key == "step", "step and a length for each axis");
        step_nano_ = numbers();
        for (std::size_t a = 0; a < step_nano_.size(); ++a) {
            check_step(line_, list_.axes[a], step_nano_[a]);
        }
    } else if (tick_nano_ == 0) {
        expect(line_, key == "tick_s" && words_.size() == 1, "tick_s and seconds");
        tick_nano_ = line_.nano({'T', words_.front()});
        expect(line_, tick_nano_ > 0, "seconds above 0");
    } else {
        expect(line_, key == "start", "start and a position for each axis");
        start();
    }
}

void Reader::start() {
    const std::vector<std::int64_t> place = numbers();
    for (std::size_t a = 0; a < place.size(); ++a) {
        check_start(line_, list_.axes[a], place[a]);
    }
    list_.blocks.push_back({.piece = marks_.piece(), .line = line_.number});
    list_.nano = place;
}

void Reader::open_block() {
    block_.ticks = block_.left = whole(line_, words_.front());
    if (block_.ticks <= 0 || block_.ticks > kMaxLinesRun) {
        wrong(line_, "a number of ticks above 0");
    }
    block_.sums.clear();
    block_.sum.assign(order_.size(), 0);
    list_.blocks.push_back(
        {.duration_s = static_cast<double>(block_.ticks) *
                       (static_cast<double>(tick_nano_) / static_cast<double>(kNanoPerUnit)),
         .piece = marks_.piece(),
         .line = line_.number});
}

void Reader::tick() {
    if (words_.size() != order_.size()) {
        wrong(line_, "the pulses of each axis; the block has " + std::to_string(block_.left) +
                         " ticks left");
    }
    for (std::size_t i = 0; i < order_.size(); ++i) {
        block_.sum[order_[i]] += whole(line_, words_[i]);
    }
    block_.sums.insert(block_.sums.end(), block_.sum.begin(), block_.sum.end());
    if (--block_.left == 0) {
        close_block();
    }
}

void Reader::close_block() {
    for (std::size_t a = 0; a < block_.sum.size(); ++a) {
        check_even(line_, block_, list_.axes[a], a);
        const std::int64_t before = list_.nano[list_.nano.size() - block_.sum.size()];
        list_.nano.push_back(
            place_after(line_, list_.axes[a], before, block_.sum[a], step_nano_[a]));
    }
}

// What is written.
struct PulseSource {
    const Machine& machine;
    const BlockList& list;
    const ProgramHeader& header;
    NcFlavour flavour;
};

// The controller's own lines.
std::string own_lines(const PulseSource& source, const std::vector<std::string>& lines) {
    const Machine& machine = source.machine;
    const LineValues values =
        line_values(source.flavour, machine, source.list, source.header, source.list.duration_s());
    std::string text;
    for (const std::string& line : filled_lines(lines, values, machine.name)) {
        try {
            Reader(machine.name, machine).comment_only(line);
        } catch (const InputError& error) {
            throw InputError("dialect.header_line", machine.name,
                             "controller line \"" + line + "\" cannot be used: " + error.words());
        }
        text += line + '\n';
    }
    return text;
}

void append_position(std::int64_t nano, const BlockAxis& axis, std::string& text) {
    text += ' ';
    append_nano(text, nano, decimals_of(axis.resolution_nano));
}

// The lines that the blocks count from.
std::string start_text(const BlockList& list) {
    std::string text = "axes";
    for (const BlockAxis& axis : list.axes) {
        text += std::string(" ") + axis.letter;
    }
    text += "\nstep";
    for (const BlockAxis& axis : list.axes) {
        append_position(axis.resolution_nano, axis, text);
    }
    text += "\ntick_s ";
    append_shortest(text, kPulseTick_s);
    text += "\nstart";
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        append_position(list.row(0)[a], list.axes[a], text);
    }
    text += '\n';
    return text;
}

void append_ticks(const BlockList& list, std::size_t block, std::int64_t ticks, std::string& text) {
    text += "block " + std::to_string(ticks) + '\n';
    for (std::int64_t k = 1; k <= ticks; ++k) {
        for (std::size_t a = 0; a < list.axes.size(); ++a) {
            const std::int64_t steps =
                (list.row(block)[a] - list.row(block - 1)[a]) / list.axes[a].resolution_nano;
            text += a > 0 ? " " : "";
            text += std::to_string(done(steps, k, ticks) - done(steps, k - 1, ticks));
        }
        text += '\n';
    }
}

// The blocks, with a mark where a course begins.
void append_blocks(const PulseSource& source, std::string& text) {
    std::int32_t piece = -1;  // of the last course mark
    std::int64_t written = 0;
    for (std::size_t i = 1; i < source.list.blocks.size(); ++i) {
        const Block& block = source.list.blocks[i];
        if (!(block.duration_s > 0.0)) {
            throw InputError("dialect.duration", "block " + std::to_string(i),
                             "takes no time; give every block a duration above 0");
        }
        if (block.piece != piece) {
            piece = block.piece;
            text += comment_lines(source.flavour, "course " + std::to_string(piece));
        }
        const std::int64_t ticks = ticks_of(block.duration_s);
        written += ticks + 1;
        if (written > kMaxLinesRun) {
            throw InputError(
                "dialect.duration", "block " + std::to_string(i),
                "the program has more than " + std::to_string(kMaxLinesRun) + " ticks; split it");
        }
        append_ticks(source.list, i, ticks, text);
    }
}

std::string program_text(const PulseSource& source) {
    const Machine& machine = source.machine;
    std::string text;
    for (std::string& words : head_comments(source.flavour, machine, source.list, source.header,
                                            source.list.duration_s())) {
        text += comment_lines(source.flavour, std::move(words));
    }
    text += own_lines(source, machine.controller.header);
    text += start_text(source.list);
    append_blocks(source, text);
    text += own_lines(source, machine.controller.footer);
    text += "end\n";
    return text;
}

}  // namespace

std::vector<double> Pulses::run_times_s(const Machine& machine, const BlockList& list) const {
    return nc_run_times_s(text_flavour(), machine, list);
}

BlockList Pulses::prepare(BlockList list) const {
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        double& duration_s = list.blocks[i].duration_s;
        if (duration_s > 0.0) {
            duration_s = static_cast<double>(ticks_of(duration_s)) * kPulseTick_s;
        }
    }
    return list;
}

std::string Pulses::write(const Machine& machine, const BlockList& list,
                          const ProgramLayout& layout, const ProgramHeader& header) const {
    assert(!list.blocks.empty() && list.axes.size() == machine.axis_count());
    assert(layout.main.empty());
    (void)layout;
    return program_text({machine, list, header, text_flavour()});
}

BlockList Pulses::read(std::string_view text, const std::string& file,
                       const Machine& machine) const {
    return Reader(file, machine).program(text);
}

// Blanks stand between numbers here: one of any number of them counts.
std::string Pulses::code_of(std::string_view text, const std::string& file) const {
    std::string spaced;
    std::vector<std::string_view> words;
    for (const std::string_view line : lines_of_text(text)) {
        const std::size_t end = std::min(line.find(';'), line.size());
        bool first = true;
        split_until(line, end, words);
        for (const std::string_view word : words) {
            spaced += (first ? "" : "_") + std::string(word);
            first = false;
        }
        spaced += std::string(line.substr(end)) + '\n';
    }
    return code_of_nc(NcComments::Semicolon, spaced, file);
}

}  // namespace meshwind
