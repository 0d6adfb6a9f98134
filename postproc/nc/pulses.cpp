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

class Reader {
public:
    Reader(const std::string& file, const Machine& machine) {
        line_.file = &file;
        line_.style = NcComments::Semicolon;
        for (std::size_t a = 0; a < machine.axis_count(); ++a) {
            const Axis& axis = machine.axis(a);
            list_.axes.push_back({axis.letter, axis.type, axis.resolution_nano});
        }
        list_.head.emplace();
    }

    BlockList program(std::string_view text) && {
        const std::vector<std::string_view> lines = lines_of_text(text);
        list_.head->by_meshwind = is_by_meshwind(lines);
        for (const std::string_view words : lines) {
            ++line_.number;
            if (line_.number > kMostLinesRun) {
                line_.fail("nc.too_many_lines", "more than " + std::to_string(kMostLinesRun) +
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

    // A line of the controller's own.
    void comment_only(std::string_view text) {
        line(text);
        if (!words_.empty() || list_.tie_on_mm) {
            wrong("only comments that tie nothing on");
        }
    }

private:
    [[noreturn]] void wrong(const std::string& expected) const {
        line_.fail("nc.pulses", "this line does not fit; expected is " + expected);
    }

    void line(std::string_view text) {
        split(text);
        if (words_.empty()) {
            return;
        }
        if (ended_) {
            wrong("nothing behind \"end\"");
        }
        if (left_ > 0) {
            tick();
            return;
        }
        const std::string_view key = words_.front();
        words_.erase(words_.begin());
        if (order_.empty()) {
            key == "axes" ? axes() : wrong("axes and their letters");
        } else if (step_nano_.empty()) {
            key == "step" ? steps() : wrong("step and a length for each axis");
        } else if (tick_nano_ == 0) {
            key == "tick_s" && words_.size() == 1 ? tick_length() : wrong("tick_s and seconds");
        } else if (list_.blocks.empty()) {
            key == "start" ? start() : wrong("start and a position for each axis");
        } else if (key == "end" && words_.empty()) {
            ended_ = true;
        } else {
            key == "block" && words_.size() == 1 ? block() : wrong("block and its ticks, or end");
        }
    }

    void split(std::string_view text) {
        line_.comments.clear();
        words_.clear();
        const std::size_t end = std::min(text.find(';'), text.size());
        if (end < text.size()) {
            const std::size_t blank = text.substr(end + 1, 1) == " " ? 1 : 0;
            line_.comments.push_back(text.substr(end + 1 + blank));
            marks_.read(line_, list_);
        }
        for (std::size_t i = 0; i < end;) {
            const std::size_t stop = std::min(text.find(' ', i), end);
            if (stop > i) {
                words_.push_back(text.substr(i, stop - i));
            }
            i = stop + 1;
        }
    }

    void axes() {
        for (const std::string_view word : words_) {
            const auto axis = std::find_if(
                list_.axes.begin(), list_.axes.end(),
                [&](const BlockAxis& a) { return word.size() == 1 && a.letter == word.front(); });
            const auto index = static_cast<std::size_t>(axis - list_.axes.begin());
            if (axis == list_.axes.end() ||
                std::find(order_.begin(), order_.end(), index) != order_.end()) {
                wrong("each letter of the machine's axes once");
            }
            order_.push_back(index);
        }
        if (order_.size() != list_.axes.size()) {
            wrong("each letter of the machine's axes once");
        }
    }

    // Of each axis, in the machine's order.
    std::vector<std::int64_t> numbers() {
        if (words_.size() != order_.size()) {
            wrong("a number for each axis");
        }
        std::vector<std::int64_t> values(order_.size());
        for (std::size_t i = 0; i < order_.size(); ++i) {
            values[order_[i]] = line_.nano({list_.axes[order_[i]].letter, words_[i]});
        }
        return values;
    }

    void steps() {
        step_nano_ = numbers();
        for (std::size_t a = 0; a < step_nano_.size(); ++a) {
            if (step_nano_[a] <= 0 || step_nano_[a] % list_.axes[a].resolution_nano != 0) {
                line_.fail("nc.resolution", std::string("the step of ") + list_.axes[a].letter +
                                                " is not a multiple of the axis' resolution");
            }
        }
    }

    void tick_length() {
        tick_nano_ = line_.nano({'T', words_.front()});
        if (tick_nano_ <= 0) {
            wrong("seconds above 0");
        }
    }

    void start() {
        const std::vector<std::int64_t> place = numbers();
        for (std::size_t a = 0; a < place.size(); ++a) {
            if (place[a] % list_.axes[a].resolution_nano != 0) {
                line_.fail("nc.resolution", std::string("the start of ") + list_.axes[a].letter +
                                                " is not a multiple of the axis' resolution");
            }
        }
        list_.blocks.push_back({.piece = marks_.piece(), .line = line_.number});
        list_.nano = place;
    }

    [[nodiscard]] std::int64_t whole(std::string_view word) const {
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc{} || end != word.data() + word.size() ||
            std::abs(value) > kMostPulses) {
            wrong("whole numbers");
        }
        return value;
    }

    void block() {
        ticks_ = left_ = whole(words_.front());
        if (ticks_ <= 0 || ticks_ > kMostLinesRun) {
            wrong("a number of ticks above 0");
        }
        sums_.clear();
        sum_.assign(order_.size(), 0);
        list_.blocks.push_back(
            {.duration_s = static_cast<double>(ticks_) *
                           (static_cast<double>(tick_nano_) / static_cast<double>(kNanoPerUnit)),
             .piece = marks_.piece(),
             .line = line_.number});
    }

    void tick() {
        if (words_.size() != order_.size()) {
            wrong("the pulses of each axis; the block has " + std::to_string(left_) +
                  " ticks left");
        }
        for (std::size_t i = 0; i < order_.size(); ++i) {
            sum_[order_[i]] += whole(words_[i]);
        }
        sums_.insert(sums_.end(), sum_.begin(), sum_.end());
        if (--left_ == 0) {
            close_block();
        }
    }

    void close_block() {
        for (std::size_t a = 0; a < sum_.size(); ++a) {
            for (std::int64_t k = 0; k < ticks_; ++k) {
                const std::int64_t sum = sums_[static_cast<std::size_t>(k) * sum_.size() + a];
                if (!is_even(sum, sum_[a], k + 1, ticks_)) {
                    line_.fail("nc.pulses",
                               std::string("the ticks of ") + list_.axes[a].letter +
                                   " in the block that ends here are more than half a step off "
                                   "an even move; close the block where its speed changes");
                }
            }
            const std::int64_t before = list_.nano[list_.nano.size() - sum_.size()];
            std::int64_t move = 0;
            std::int64_t place = 0;
            if (__builtin_mul_overflow(sum_[a], step_nano_[a], &move) ||
                __builtin_add_overflow(before, move, &place)) {
                wrong("a position within 9e9 mm or deg");
            }
            if (const std::string words = beyond_one_block(list_.axes[a], before, place);
                !words.empty()) {
                line_.fail("nc.too_far", words);
            }
            list_.nano.push_back(place);
        }
    }

    // Sums over kMostLinesRun ticks must fit.
    static constexpr std::int64_t kMostPulses = 1'000'000'000;

    NcLine line_;
    NcMarks marks_;
    BlockList list_;
    std::vector<std::string_view> words_;
    std::vector<std::size_t> order_;  // of the columns
    std::vector<std::int64_t> step_nano_;
    std::int64_t tick_nano_ = 0;
    std::int64_t ticks_ = 0;  // of the block
    std::int64_t left_ = 0;
    std::vector<std::int64_t> sum_;   // of the block
    std::vector<std::int64_t> sums_;  // at each tick of it
    bool ended_ = false;
};

class Writer {
public:
    Writer(const Machine& machine, const BlockList& list, const ProgramHeader& header)
        : machine_(machine), list_(list), header_(header), flavour_(text_flavour()) {}

    std::string program() && {
        for (std::string& words :
             head_comments(flavour_, machine_, list_, header_, list_.duration_s())) {
            text_ += comment_lines(flavour_, std::move(words));
        }
        own_lines(machine_.controller.header);
        text_ += "axes";
        for (const BlockAxis& axis : list_.axes) {
            text_ += std::string(" ") + axis.letter;
        }
        text_ += "\nstep";
        for (const BlockAxis& axis : list_.axes) {
            position(axis.resolution_nano, axis);
        }
        text_ += "\ntick_s ";
        append_shortest(text_, kPulseTick_s);
        text_ += "\nstart";
        for (std::size_t a = 0; a < list_.axes.size(); ++a) {
            position(list_.row(0)[a], list_.axes[a]);
        }
        text_ += '\n';
        for (std::size_t i = 1; i < list_.blocks.size(); ++i) {
            block(i);
        }
        own_lines(machine_.controller.footer);
        text_ += "end\n";
        return std::move(text_);
    }

private:
    void own_lines(const std::vector<std::string>& lines) {
        const LineValues values =
            line_values(flavour_, machine_, list_, header_, list_.duration_s());
        for (const std::string& line : filled_lines(lines, values, machine_.name)) {
            try {
                Reader(machine_.name, machine_).comment_only(line);
            } catch (const InputError& error) {
                throw InputError(
                    "dialect.header_line", machine_.name,
                    "controller line \"" + line + "\" cannot be used: " + error.words());
            }
            text_ += line + '\n';
        }
    }

    void position(std::int64_t nano, const BlockAxis& axis) {
        text_ += ' ';
        append_nano(text_, nano, decimals_of(axis.resolution_nano));
    }

    void block(std::size_t i) {
        const Block& block = list_.blocks[i];
        if (!(block.duration_s > 0.0)) {
            throw InputError("dialect.duration", "block " + std::to_string(i),
                             "takes no time; give every block a duration above 0");
        }
        if (block.piece != piece_) {
            piece_ = block.piece;
            text_ += comment_lines(flavour_, "course " + std::to_string(piece_));
        }
        const std::int64_t ticks = ticks_of(block.duration_s);
        written_ += ticks + 1;
        if (written_ > kMostLinesRun) {
            throw InputError(
                "dialect.duration", "block " + std::to_string(i),
                "the program has more than " + std::to_string(kMostLinesRun) + " ticks; split it");
        }
        text_ += "block " + std::to_string(ticks) + '\n';
        for (std::int64_t k = 1; k <= ticks; ++k) {
            for (std::size_t a = 0; a < list_.axes.size(); ++a) {
                const std::int64_t steps =
                    (list_.row(i)[a] - list_.row(i - 1)[a]) / list_.axes[a].resolution_nano;
                text_ += a > 0 ? " " : "";
                text_ += std::to_string(done(steps, k, ticks) - done(steps, k - 1, ticks));
            }
            text_ += '\n';
        }
    }

    const Machine& machine_;
    const BlockList& list_;
    const ProgramHeader& header_;
    NcFlavour flavour_;
    std::string text_;
    std::int32_t piece_ = -1;  // of the last course mark
    std::int64_t written_ = 0;
};

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
    return Writer(machine, list, header).program();
}

BlockList Pulses::read(std::string_view text, const std::string& file,
                       const Machine& machine) const {
    return Reader(file, machine).program(text);
}

// Blanks stand between numbers here: one of any number of them counts.
std::string Pulses::code_of(std::string_view text, const std::string& file) const {
    std::string spaced;
    for (const std::string_view line : lines_of_text(text)) {
        const std::size_t end = std::min(line.find(';'), line.size());
        bool first = true;
        for (std::size_t i = 0; i < end;) {
            const std::size_t stop = std::min(line.find(' ', i), end);
            if (stop > i) {
                spaced += (first ? "" : "_") + std::string(line.substr(i, stop - i));
                first = false;
            }
            i = stop + 1;
        }
        spaced += std::string(line.substr(end)) + '\n';
    }
    return code_of_nc(NcComments::Semicolon, spaced, file);
}

}  // namespace meshwind
