#include "postproc/robot/tp_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include "core/text/lower_case.h"
#include "core/text/text_number.h"
#include "postproc/nc/nc_reader.h"
#include "postproc/robot/robot_axes.h"
#include "postproc/robot/robot_blocks.h"
#include "postproc/robot/robot_head.h"
#include "postproc/robot/tp_program.h"

namespace meshwind {
namespace {

// Beginnings of instructions without effect on where the axes are and when: loads, outputs, words
// for the operator.
constexpr std::array<std::string_view, 6> kIdle = {"payload[", "do[", "ro[",
                                                   "go[",      "ao[", "message["};

// The attribute that says which groups of axes move.
constexpr std::string_view kGroups = "default_group=";

// Text without blanks, piece by piece.
class Cursor {
public:
    explicit Cursor(std::string_view text) : rest_(text) {}

    [[nodiscard]] bool at_end() const { return rest_.empty(); }

    bool take(std::string_view word) {
        const bool found = rest_.substr(0, word.size()) == word;
        rest_.remove_prefix(found ? word.size() : 0);
        return found;
    }

    // Characters out of these; empty where another stands.
    std::string_view take_all(std::string_view characters) {
        const std::size_t end = std::min(rest_.find_first_not_of(characters), rest_.size());
        const std::string_view taken = rest_.substr(0, end);
        rest_.remove_prefix(end);
        return taken;
    }

    // Whole number; -1 where none stands that is small enough.
    std::int32_t take_count() {
        const std::string_view digits = take_all("0123456789");
        std::int32_t count = -1;
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), count);
        return error == std::errc{} ? count : -1;
    }

    // Up to a character, which stays; all where there is none.
    void skip_to(char c) { rest_.remove_prefix(std::min(rest_.find(c), rest_.size())); }

private:
    std::string_view rest_;
};

// A position of the program.
struct Position {
    std::vector<std::int64_t> nano{};
    std::vector<bool> placed{};
    std::int32_t line = 0;
};

// Reads a program into blocks: its positions, then its instructions.
class Reader {
public:
    Reader(std::string_view text, const std::string& file, const Machine& machine)
        : machine_(machine),
          axes_(robot_axes(machine)),
          coupling_(tp_coupling(machine, axes_)),
          groups_(tp_groups(axes_)),
          lines_(tp_lines(text)),
          blocks_(tp_text(lines_), file, machine, "a time") {}

    [[nodiscard]] BlockList program(std::string_view text) &&;
    void own_line(std::string_view text);

private:
    // What a line may be, in the order of a program.
    enum class Part { Name, Attributes, Instructions, Positions, Ended };
    // What may follow in a position.
    enum class Next { Group, Frame, Axis, End };

    [[noreturn]] void not_understood();
    void frame(std::string_view text);
    void line(std::string_view words);
    void attribute(std::string_view code);
    void position_line(std::string_view code);
    void open_position(Cursor& cursor);
    void close_position();
    void open_group(Cursor& cursor);
    void component(Cursor& cursor);

    void instruction(std::string_view code);
    void move(Cursor& cursor);
    [[nodiscard]] double seconds(Cursor& cursor);
    [[nodiscard]] bool is_stop(Cursor& cursor);
    NcLine& here() { return blocks_.line(); }

    const Machine& machine_;
    RobotAxes axes_;
    int coupling_;
    std::vector<TpGroup> groups_;
    std::vector<TpLine> lines_;
    RobotBlocks blocks_;
    std::string words_;  // that are being read, as they stand
    Part part_ = Part::Name;
    bool has_groups_ = false;
    std::map<std::int32_t, Position> positions_;
    Position* open_ = nullptr;  // the position that is being read
    std::size_t group_ = 0;     // of these, from 1; 0: none yet
    Next next_ = Next::Group;
    std::size_t first_ = 0;  // of kTpFirstLines that were read
};

void Reader::not_understood() {
    here().fail("nc.not_understood",
                "\"" + words_ + "\" is not part of the subset that is read back here");
}

BlockList Reader::program(std::string_view text) && {
    frame(text);
    for (const TpLine& line : lines_) {
        here().number = line.line;
        words_ = line.text;
        if (!line.is_whole) {
            not_understood();
        }
        if (words_.substr(0, 1) == "!") {
            blocks_.comment(std::string_view(words_).substr(2), line.line);
        } else if (!words_.empty()) {
            instruction(packed_tp(words_));
        }
    }
    return blocks_.take();
}

// All but the instructions.
void Reader::frame(std::string_view text) {
    for (const std::string_view words : lines_of_text(text)) {
        ++here().number;
        line(words);
    }
    if (part_ != Part::Ended) {
        here().fail("nc.no_end", "the program has no /END; the file may be cut off");
    }
}

void Reader::line(std::string_view words) {
    words_ = words;
    const std::string code = packed_tp(words);
    if (code.empty()) {
        return;
    }
    switch (part_) {
        case Part::Name:
            if (code.substr(0, 5) != "/prog" || code.size() < 6) {
                not_understood();
            }
            part_ = Part::Attributes;
            return;
        case Part::Attributes:
            attribute(code);
            return;
        case Part::Instructions:
            if (code.front() == '/') {
                part_ = Part::Positions;
                if (words != "/POS") {
                    not_understood();
                }
            }
            return;
        case Part::Positions:
            position_line(code);
            return;
        case Part::Ended:
            not_understood();
    }
}

// What else stands there is about the file and its application.
void Reader::attribute(std::string_view code) {
    const std::string groups = std::string(kGroups) + tp_default_group(axes_) + ';';
    if (code.substr(0, kGroups.size()) == kGroups) {
        has_groups_ = true;
        if (code != groups) {
            here().fail("nc.no_axis", "\"" + words_ + "\" moves other groups of axes than the " +
                                          "machine \"" + machine_.name + "\" has (" +
                                          tp_default_group(axes_) +
                                          "); is it the machine of this program?");
        }
    }
    if (words_ == "/MN") {
        if (!has_groups_) {
            here().fail("nc.no_axis", "no DEFAULT_GROUP says which groups of axes move; write \"" +
                                          tp_default_group(axes_) + '"');
        }
        part_ = Part::Instructions;
    } else if (code == "/pos" || code == "/end") {
        not_understood();
    }
}

// A line between /POS and /END, which may hold any number of pieces.
void Reader::position_line(std::string_view code) {
    Cursor cursor(code);
    if (open_ == nullptr && cursor.take("/end") && cursor.at_end()) {
        part_ = Part::Ended;
        return;
    }
    while (!cursor.at_end()) {
        if (open_ == nullptr) {
            open_position(cursor);
        } else if (next_ == Next::Frame) {
            if (!cursor.take("uf:0,ut:1,")) {
                not_understood();
            }
            next_ = Next::Axis;
        } else if (next_ == Next::Axis) {
            component(cursor);
            next_ = cursor.take(",") ? Next::Axis : Next::End;
        } else if (next_ == Next::End && cursor.take("};")) {
            close_position();
        } else {
            open_group(cursor);
        }
    }
}

// P[5:"name"]{
void Reader::open_position(Cursor& cursor) {
    const std::int32_t number = cursor.take("p[") ? cursor.take_count() : -1;
    if (cursor.take(":")) {
        cursor.skip_to(']');
    }
    if (number < 1 || !cursor.take("]{")) {
        not_understood();
    }
    const auto [at, is_new] = positions_.emplace(number, Position{});
    if (!is_new) {
        here().fail("nc.no_position", "P[" + std::to_string(number) + "] stands twice");
    }
    open_ = &at->second;
    open_->nano.assign(machine_.axis_count(), 0);
    open_->placed.assign(machine_.axis_count(), false);
    open_->line = here().number;
    group_ = 0;
    next_ = Next::Group;
}

void Reader::close_position() {
    const auto missing = std::find(open_->placed.begin(), open_->placed.end(), false);
    if (missing != open_->placed.end()) {
        here().number = open_->line;
        const auto joint = static_cast<std::size_t>(missing - open_->placed.begin());
        here().fail("nc.no_axis",
                    std::string("axis ") + machine_.axis(joint).letter + " has no position");
    }
    std::int64_t& third = open_->nano[axes_.arm[2]];
    if (__builtin_sub_overflow(third, coupling_ * open_->nano[axes_.arm[1]], &third)) {
        here().fail("nc.number", "the angle of J3 is too large");
    }
    open_ = nullptr;
}

// GP1:
void Reader::open_group(Cursor& cursor) {
    const std::int32_t number = cursor.take("gp") ? cursor.take_count() : -1;
    ++group_;
    if (number != static_cast<std::int32_t>(group_) || group_ > groups_.size() ||
        !cursor.take(":")) {
        not_understood();
    }
    next_ = Next::Frame;
}

// J1= .. deg
void Reader::component(Cursor& cursor) {
    const std::vector<TpAxis>& axes = groups_[group_ - 1].axes;
    const std::string name(cursor.take_all("jexyzwpr123456789"));
    const auto axis = std::find_if(axes.begin(), axes.end(),
                                   [&](const TpAxis& one) { return lower_case(one.name) == name; });
    if (name.empty() || !cursor.take("=")) {
        not_understood();
    }
    if (axis == axes.end()) {
        here().fail("nc.no_axis",
                    '"' + name + "\" has a position in group " + std::to_string(group_) +
                        ", and the machine \"" + machine_.name +
                        "\" has no such axis there; is it the machine of this program?");
    }
    const std::size_t joint = axis->joint;
    const std::string_view digits = cursor.take_all("+-.0123456789");
    const char* const unit = machine_.axis(joint).type == AxisType::Rotary ? "deg" : "mm";
    if (digits.empty() || !cursor.take(unit)) {
        not_understood();
    }
    if (open_->placed[joint]) {
        here().fail("nc.word_twice", axis->name + " stands twice");
    }
    open_->placed[joint] = true;
    open_->nano[joint] = here().nano({machine_.axis(joint).letter, digits});
}

void Reader::own_line(std::string_view text) {
    words_ = text;
    const std::string code = packed_tp(text);
    const bool idle = std::any_of(kIdle.begin(), kIdle.end(), [&](std::string_view begin) {
        return code.substr(0, begin.size()) == begin;
    });
    if (text.find(';') != std::string_view::npos) {
        not_understood();
    }
    if (code.substr(0, 1) == "!") {
        const std::size_t first = text.find_first_not_of(' ', text.find('!') + 1);
        blocks_.comment(text.substr(std::min(first, text.size())), here().number);
    } else if (!code.empty() && !idle) {
        not_understood();
    }
    if (blocks_.ties_on()) {
        here().fail("nc.tie_on", "it ties the fibre on or places pins");
    }
}

void Reader::instruction(std::string_view code) {
    if (first_ < kTpFirstLines.size()) {
        if (code != lower_case(kTpFirstLines[first_])) {
            here().fail("nc.not_understood", "\"" + words_ + "\" stands where \"" +
                                                 std::string(kTpFirstLines[first_]) +
                                                 "\" is expected");
        }
        ++first_;
        return;
    }
    Cursor cursor(code);
    if (cursor.take("jp[")) {
        move(cursor);
    } else if (code == "pause") {
        blocks_.stop(here().number);
    } else if (std::none_of(kIdle.begin(), kIdle.end(), [&](std::string_view begin) {
                   return code.substr(0, begin.size()) == begin;
               })) {
        not_understood();
    }
}

// J P[5] 87msec CNT100, or with a share of the speed to the start.
void Reader::move(Cursor& cursor) {
    RobotMove to = blocks_.next(here().number);
    const std::int32_t number = cursor.take_count();
    if (cursor.take(":")) {
        cursor.skip_to(']');
    }
    if (!cursor.take("]")) {
        not_understood();
    }
    to.duration_s = seconds(cursor);
    to.stops = is_stop(cursor);
    const auto at = positions_.find(number);
    if (at == positions_.end()) {
        here().fail("nc.no_position",
                    "\"" + words_ + "\" leads to a position that is not behind /POS");
    }
    to.nano = at->second.nano;
    blocks_.move(std::move(to));
}

// 0 for a share of the speed.
double Reader::seconds(Cursor& cursor) {
    const std::string_view digits = cursor.take_all(".0123456789");
    if (digits.empty()) {
        not_understood();
    }
    const std::int64_t nano = here().nano({'J', digits});
    if (cursor.take("%")) {
        return 0.0;
    }
    const bool fine = cursor.take("msec");
    if (!fine && !cursor.take("sec")) {
        not_understood();
    }
    const std::int64_t tick = fine ? kNanoPerUnit : kNanoPerUnit / 10;
    const double most = fine ? 1000.0 * kTpMostFine_s : kTpMost_s;
    const double value = static_cast<double>(nano) / static_cast<double>(kNanoPerUnit);
    if (nano < tick || nano % tick != 0 || value > most) {
        here().fail("nc.feed", "\"" + words_ +
                                   "\" has a time that FANUC's TP cannot say: whole msec up to " +
                                   fixed(1000.0 * kTpMostFine_s, 0) + ", tenths of a sec up to " +
                                   fixed(kTpMost_s, 0));
    }
    return fine ? value / 1000.0 : value;
}

bool Reader::is_stop(Cursor& cursor) {
    if (cursor.take("fine") && cursor.at_end()) {
        return true;
    }
    const std::int32_t share = cursor.take("cnt") ? cursor.take_count() : -1;
    if (share < 0 || share > 100 || !cursor.at_end()) {
        not_understood();
    }
    return share == 0;
}

}  // namespace

BlockList read_tp(std::string_view text, const std::string& file, const Machine& machine) {
    return Reader(text, file, machine).program(text);
}

void check_own_tp_line(const Machine& machine, const std::string& line) {
    check_robot_line(machine, line, [&] { Reader("", machine.name, machine).own_line(line); });
}

std::string packed_tp(std::string_view text) {
    std::string packed;
    for (const char c : text) {
        if (c != ' ' && c != '\t') {
            packed += lower_case(c);
        }
    }
    return packed;
}

}  // namespace meshwind
