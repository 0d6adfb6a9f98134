#include "postproc/robot/krl_reader.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>
#include <vector>

#include "core/text/lower_case.h"
#include "postproc/robot/krl_program.h"
#include "postproc/robot/robot_axes.h"
#include "postproc/robot/robot_blocks.h"
#include "postproc/robot/robot_head.h"

namespace meshwind {
namespace {

// Beginnings of lines without effect on where the axes are and when: tool, base and load, outputs.
constexpr std::array<std::string_view, 7> kIdle = {"$tool=",  "$base=",     "$load=",    "$out[",
                                                   "$anout[", "bas(#tool,", "bas(#base,"};

bool is_blank(char c) {
    return c == ' ' || c == '\t';
}

// The words of a line, one after the other.
class Cursor {
public:
    explicit Cursor(std::string_view text) : rest_(text) { skip(); }

    [[nodiscard]] bool at_end() const { return rest_.empty(); }
    [[nodiscard]] std::string_view rest() const { return rest_; }

    // A word in small letters and what ends it; false where another stands.
    bool take(std::string_view word) {
        const bool found = lower_case(rest_.substr(0, word.size())) == word;
        const bool letters = std::isalnum(static_cast<unsigned char>(word.back())) != 0;
        const bool ends = rest_.size() <= word.size() || !letters ||
                          (std::isalnum(static_cast<unsigned char>(rest_[word.size()])) == 0 &&
                           rest_[word.size()] != '_');
        if (!found || !ends) {
            return false;
        }
        rest_.remove_prefix(word.size());
        skip();
        return true;
    }

    // Digits with sign and point; empty where there are none.
    std::string_view number() {
        const std::size_t end = std::min(rest_.find_first_not_of("+-.0123456789"), rest_.size());
        const std::string_view digits = rest_.substr(0, end);
        rest_.remove_prefix(end);
        skip();
        return digits;
    }

private:
    void skip() {
        while (!rest_.empty() && is_blank(rest_.front())) {
            rest_.remove_prefix(1);
        }
    }

    std::string_view rest_;
};

// The code of a line in small letters without blanks.
std::string packed(std::string_view code) {
    std::string text;
    std::copy_if(code.begin(), code.end(), std::back_inserter(text),
                 [](char c) { return !is_blank(c); });
    return lower_case(text);
}

// Reads a program line by line into blocks.
class Reader {
public:
    Reader(std::string_view text, const std::string& file, const Machine& machine)
        : machine_(machine),
          axes_(robot_axes(machine)),
          blocks_(text, file, machine, "a share of a time block") {}

    [[nodiscard]] BlockList program(std::string_view text) &&;
    void own_line(std::string_view text);

private:
    // What a line may be, in the order of a program.
    enum class Part { Access, Name, Settings, Moves, Start, Points, Behind, Ended };

    [[noreturn]] void not_understood();
    std::string_view code_of(std::string_view text);
    void line(std::string_view code);
    void outside(std::string_view code);
    void settings(std::string_view code);
    void spline(std::string_view code);
    void point(Cursor& cursor);
    void part(Cursor& cursor);
    void end_of_time(Cursor& cursor);
    void end_of_spline(Cursor& cursor);
    RobotMove place(Cursor& cursor);
    [[nodiscard]] std::optional<std::size_t> component(Cursor& cursor, std::string& name) const;
    std::int64_t seconds(Cursor& cursor);
    [[nodiscard]] static bool is_idle(std::string_view code);
    NcLine& here() { return blocks_.line(); }

    const Machine& machine_;
    RobotAxes axes_;
    RobotBlocks blocks_;
    std::string_view code_;
    Part part_ = Part::Access;
    std::size_t settings_ = 0;        // of kKrlFirstLines that were read
    std::size_t winding_ = 0;         // of kKrlWindingLines, behind the last move to the start
    std::vector<RobotMove> points_;   // of the spline block that is open
    std::vector<std::int64_t> time_;  // shares of these, nanoseconds
    bool timed_ = false;              // the time of the spline block was read
};

void Reader::not_understood() {
    here().fail("nc.not_understood",
                "\"" + std::string(code_) + "\" is not part of the subset that is read back here");
}

// What stands before the comment, which is told of.
std::string_view Reader::code_of(std::string_view text) {
    const std::size_t open = std::min(text.find(';'), text.size());
    if (open < text.size()) {
        std::string_view words = text.substr(open + 1);
        words.remove_prefix(!words.empty() && words.front() == ' ' ? 1 : 0);
        words.remove_suffix(words.size() -
                            std::min(words.find_last_not_of(" \t") + 1, words.size()));
        blocks_.comment(words, here().number);
    }
    std::string_view code = text.substr(0, open);
    while (!code.empty() && is_blank(code.back())) {
        code.remove_suffix(1);
    }
    const std::size_t first = std::min(code.find_first_not_of(" \t"), code.size());
    return code.substr(first);
}

BlockList Reader::program(std::string_view text) && {
    for (const std::string_view words : lines_of_text(text)) {
        ++here().number;
        code_ = code_of(words);
        if (!code_.empty()) {
            line(code_);
        }
    }
    if (part_ != Part::Ended) {
        here().fail("nc.no_end", "the program has no END; the file may be cut off");
    }
    return blocks_.take();
}

void Reader::own_line(std::string_view text) {
    code_ = code_of(text);
    if (!code_.empty() && !is_idle(code_)) {
        not_understood();
    }
    if (blocks_.ties_on()) {
        here().fail("nc.tie_on", "it ties the fibre on or places pins");
    }
}

bool Reader::is_idle(std::string_view code) {
    const std::string line = packed(code);
    return std::any_of(kIdle.begin(), kIdle.end(), [&](std::string_view begin) {
        return line.substr(0, begin.size()) == begin;
    });
}

void Reader::line(std::string_view code) {
    Cursor cursor(code);
    switch (part_) {
        case Part::Access:
            if (code.front() == '&') {
                return;
            }
            part_ = Part::Name;
            [[fallthrough]];
        case Part::Name: {
            const bool begins = cursor.take("def");
            const std::string name = packed(cursor.rest());
            if (!begins || name.size() < 3 || name.substr(name.size() - 2) != "()") {
                not_understood();
            }
            part_ = Part::Settings;
            return;
        }
        case Part::Settings:
            settings(code);
            return;
        case Part::Start:
            if (!cursor.take("time_block") || !cursor.take("start") || !cursor.at_end()) {
                not_understood();
            }
            part_ = Part::Points;
            return;
        case Part::Points:
            spline(code);
            return;
        case Part::Moves:
        case Part::Behind:
            outside(code);
            return;
        case Part::Ended:
            not_understood();
    }
}

// The lines before the first move, all in their order.
void Reader::settings(std::string_view code) {
    if (packed(code) != lower_case(kKrlFirstLines[settings_])) {
        here().fail("nc.not_understood", "\"" + std::string(code) + "\" stands where \"" +
                                             std::string(kKrlFirstLines[settings_]) +
                                             "\" is expected");
    }
    ++settings_;
    part_ = settings_ == kKrlFirstLines.size() ? Part::Moves : part_;
}

// Between and beside spline blocks.
void Reader::outside(std::string_view code) {
    Cursor cursor(code);
    const bool setting = winding_ < kKrlWindingLines.size() &&
                         packed(code) == lower_case(kKrlWindingLines[winding_]);
    if (setting && part_ == Part::Moves) {
        ++winding_;
    } else if (cursor.take("ptp_spline") && cursor.at_end()) {
        if (winding_ != kKrlWindingLines.size()) {
            here().fail("nc.not_understood", "a spline block begins before \"" +
                                                 std::string(kKrlWindingLines[winding_]) + '"');
        }
        part_ = Part::Start;
    } else if (cursor.take("ptp")) {
        blocks_.move(place(cursor));
        winding_ = 0;
    } else if (cursor.take("halt") && cursor.at_end()) {
        blocks_.stop(here().number);
    } else if (cursor.take("end") && cursor.at_end()) {
        part_ = Part::Ended;
    } else if (!is_idle(code)) {
        not_understood();
    }
}

// Between TIME_BLOCK START and the end of the spline block.
void Reader::spline(std::string_view code) {
    Cursor cursor(code);
    if (cursor.take("sptp")) {
        point(cursor);
        return;
    }
    if (cursor.take("endspline")) {
        end_of_spline(cursor);
        return;
    }
    const bool of_time = cursor.take("time_block");
    if (of_time && cursor.take("part")) {
        part(cursor);
    } else if (of_time && cursor.take("end")) {
        end_of_time(cursor);
    } else {
        not_understood();
    }
}

void Reader::point(Cursor& cursor) {
    if (timed_ || points_.size() != time_.size()) {
        here().fail("nc.feed",
                    "a segment without a share of the time before it; write TIME_BLOCK "
                    "PART behind each");
    }
    points_.push_back(place(cursor));
}

void Reader::part(Cursor& cursor) {
    if (timed_ || points_.size() != time_.size() + 1) {
        here().fail("nc.feed", "a share of the time without a segment; write one behind each SPTP");
    }
    time_.push_back(seconds(cursor));
}

// The shares are those of what stands here, whatever their sum.
void Reader::end_of_time(Cursor& cursor) {
    if (timed_ || points_.empty() || points_.size() != time_.size()) {
        here().fail("nc.feed", "the time block ends without a share for each segment");
    }
    timed_ = true;
    const std::int64_t whole = seconds(cursor);
    std::int64_t sum = 0;
    for (const std::int64_t share : time_) {
        if (__builtin_add_overflow(sum, share, &sum)) {
            here().fail("nc.number", "the shares of the time are too large to be summed");
        }
    }
    const double scale = sum == whole ? 1.0 : static_cast<double>(whole) / static_cast<double>(sum);
    for (std::size_t i = 0; i < points_.size(); ++i) {
        points_[i].duration_s =
            static_cast<double>(time_[i]) / static_cast<double>(kNanoPerUnit) * scale;
    }
}

void Reader::end_of_spline(Cursor& cursor) {
    if (!timed_) {
        here().fail("nc.feed", "the spline block has no TIME_BLOCK END; its time is unknown");
    }
    points_.back().stops = !cursor.take("c_spl");
    if (!cursor.at_end()) {
        not_understood();
    }
    for (RobotMove& to : points_) {
        blocks_.move(std::move(to));
    }
    points_.clear();
    time_.clear();
    timed_ = false;
    part_ = Part::Behind;
}

// =0.0865
std::int64_t Reader::seconds(Cursor& cursor) {
    if (!cursor.take("=")) {
        not_understood();
    }
    const std::string_view digits = cursor.number();
    if (digits.empty() || !cursor.at_end()) {
        not_understood();
    }
    const std::int64_t nano = here().nano({'=', digits});
    if (nano <= 0) {
        here().fail("nc.feed", '"' + std::string(digits) + "\" is not a time above 0");
    }
    return nano;
}

// {A1 .., .., E1 ..}, each axis once.
RobotMove Reader::place(Cursor& cursor) {
    RobotMove to = blocks_.next(here().number);
    std::vector<bool> placed(to.nano.size(), false);
    std::string_view before = "{";
    while (cursor.take(before)) {
        std::string name;
        const std::optional<std::size_t> joint = component(cursor, name);
        const std::string_view digits = cursor.number();
        if (digits.empty() || name.empty()) {
            not_understood();
        }
        if (!joint) {
            here().fail("nc.no_axis",
                        name + " has a position, and the machine \"" + machine_.name +
                            "\" has no such axis; is it the machine of this program?");
        }
        if (placed[*joint]) {
            here().fail("nc.word_twice", name + " stands twice");
        }
        placed[*joint] = true;
        to.nano[*joint] = here().nano({blocks_.axes()[*joint].letter, digits});
        before = ",";
    }
    const auto missing = std::find(placed.begin(), placed.end(), false);
    if (!cursor.take("}") || !cursor.at_end()) {
        not_understood();
    }
    if (missing != placed.end()) {
        here().fail("nc.no_axis",
                    std::string("axis ") +
                        blocks_.axes()[static_cast<std::size_t>(missing - placed.begin())].letter +
                        " has no position");
    }
    return to;
}

// The joint of a name, and the name in capital letters; empty where it is none.
std::optional<std::size_t> Reader::component(Cursor& cursor, std::string& name) const {
    for (std::size_t i = 0; i < kArmAxes; ++i) {
        if (cursor.take("a" + std::to_string(i + 1))) {
            name = "A" + std::to_string(i + 1);
            return axes_.arm[i];
        }
        if (cursor.take(lower_case(kKrlLanguage.external[i]))) {
            name = kKrlLanguage.external[i];
            return axes_.external[i];
        }
    }
    return std::nullopt;
}

}  // namespace

BlockList read_robot_krl(std::string_view text, const std::string& file, const Machine& machine) {
    return Reader(text, file, machine).program(text);
}

void check_own_krl_line(const Machine& machine, const std::string& line) {
    check_robot_line(machine, line, [&] { Reader(line, machine.name, machine).own_line(line); });
}

}  // namespace meshwind
