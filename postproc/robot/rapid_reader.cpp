#include "postproc/robot/rapid_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/text/lower_case.h"
#include "postproc/robot/rapid.h"
#include "postproc/robot/rapid_tokens.h"
#include "postproc/robot/robot_axes.h"
#include "postproc/robot/robot_blocks.h"
#include "postproc/robot/robot_head.h"

namespace meshwind {
namespace {

// What RAPID has in place of an axis that is not there.
constexpr double kNoAxis = 9e9;

// Instructions without effect on where the axes are and when: loads, ramps, mechanical units on and
// off, outputs, words for the operator.
constexpr std::array<std::string_view, 16> kIdle = {
    "accset",     "actunit", "confj", "confl", "deactunit", "gripload", "motionsup", "pathresol",
    "pathacclim", "reset",   "set",   "setao", "setdo",     "setgo",    "tperase",   "tpwrite"};

// Zones that are declared by the controller; z0 is the smallest.
constexpr std::array<std::string_view, 14> kZones = {"z0",  "z1",   "z5",   "z10", "z15",
                                                     "z20", "z30",  "z40",  "z50", "z60",
                                                     "z80", "z100", "z150", "z200"};

// Records that a program may declare, and how many fields they have.
struct Record {
    std::string_view type;
    std::size_t fields;
};
constexpr std::array<Record, 5> kRecords = {
    {{"speeddata", 4}, {"zonedata", 7}, {"tooldata", 3}, {"wobjdata", 5}, {"loaddata", 6}}};
// Records within records of these have no more levels.
constexpr std::size_t kMaxLevels = 4;

// Reads a program statement by statement into blocks.
class Reader {
public:
    Reader(std::string_view text, const std::string& file, const Machine& machine);

    [[nodiscard]] BlockList program() &&;

    // A line of the machine's own, which stands outside a program.
    void own_line();

private:
    using Kind = RapidToken::Kind;

    void next() {
        token_ = tokens_.next();
        line_.number = token_.line;
    }
    [[noreturn]] void not_understood();
    void expect_mark(std::string_view mark);
    void expect_word(std::string_view word);
    std::string_view name();

    void data();
    std::size_t record(std::size_t level);
    void statement();
    void idle();

    void move();
    RobotMove target();
    [[nodiscard]] std::optional<std::int64_t> position(char letter);
    void targets(std::span<const std::optional<std::size_t>> joints, RobotMove& to);
    void speed(RobotMove& to);
    void zone(RobotMove& to);
    [[nodiscard]] double seconds();

    const Machine& machine_;
    RobotAxes axes_;
    RobotBlocks blocks_;
    NcLine& line_ = blocks_.line();
    RapidTokens tokens_;
    RapidToken token_;
    std::set<std::string> corners_;  // zones that are declared and flown by
    bool owned_ = false;             // a line of the machine's own is read
};

Reader::Reader(std::string_view text, const std::string& file, const Machine& machine)
    : machine_(machine),
      axes_(robot_axes(machine)),
      blocks_(text, file, machine, "\\T"),
      tokens_(text, [this](std::string_view comment, std::int32_t line) {
          blocks_.comment(comment, line);
      }) {
    line_.style = NcComments::Exclamation;
}

void Reader::not_understood() {
    if (token_.kind == Kind::End) {
        line_.fail("nc.no_end", owned_ ? "an instruction is not whole; close it with a semicolon"
                                       : "the program has no ENDMODULE; the file may be cut off");
    }
    line_.fail("nc.not_understood",
               "\"" + std::string(token_.text) + "\" is not part of the subset that is read back");
}

void Reader::expect_mark(std::string_view mark) {
    if (!token_.is(mark)) {
        not_understood();
    }
    next();
}

void Reader::expect_word(std::string_view word) {
    if (!token_.is_word(word)) {
        not_understood();
    }
    next();
}

std::string_view Reader::name() {
    if (token_.kind != Kind::Word) {
        not_understood();
    }
    const std::string_view text = token_.text;
    next();
    return text;
}

BlockList Reader::program() && {
    next();
    expect_word("module");
    (void)name();
    while (!token_.is_word("proc")) {
        data();
    }
    next();
    expect_word("main");
    expect_mark("(");
    expect_mark(")");
    while (!token_.is_word("endproc")) {
        statement();
    }
    next();
    expect_word("endmodule");
    if (token_.kind != Kind::End) {
        not_understood();  // behind the end only comments may stand
    }
    return blocks_.take();
}

// CONST zonedata corner:=[FALSE,10,15,15,15,15,45];
void Reader::data() {
    if (token_.is_word("local") || token_.is_word("task")) {
        next();
    }
    if (!token_.is_word("const") && !token_.is_word("pers") && !token_.is_word("var")) {
        not_understood();
    }
    next();
    const auto type = std::find_if(kRecords.begin(), kRecords.end(), [&](const Record& record) {
        return token_.is_word(record.type);
    });
    if (type == kRecords.end()) {
        not_understood();
    }
    next();
    const std::string named = lower_case(name());
    expect_mark(":=");
    const std::int32_t line = token_.line;
    expect_mark("[");
    const bool flies = token_.is_word("false");
    const std::size_t fields = record(1);
    if (fields != type->fields) {
        line_.number = line;
        line_.fail("nc.not_understood", std::string(type->type) + " \"" + named + "\" has " +
                                            std::to_string(fields) + " fields, not " +
                                            std::to_string(type->fields));
    }
    if (type->type == "zonedata" && flies) {
        corners_.insert(named);
    }
    expect_mark(";");
}

// The fields up to the bracket that closes a record, and how many they are.
std::size_t Reader::record(std::size_t level) {
    for (std::size_t fields = 1;; ++fields) {
        if (token_.is("[") && level < kMaxLevels) {
            next();
            (void)record(level + 1);
        } else {
            if (token_.is("-")) {
                next();
            }
            const bool value = token_.kind == Kind::Number || token_.kind == Kind::Text ||
                               token_.is_word("true") || token_.is_word("false");
            if (!value) {
                not_understood();
            }
            next();
        }
        if (token_.is("]")) {
            next();
            return fields;
        }
        expect_mark(",");
    }
}

void Reader::statement() {
    if (token_.is_word("moveabsj")) {
        move();
    } else if (token_.is_word("stop")) {
        blocks_.stop(token_.line);
        next();
    } else {
        idle();
    }
    expect_mark(";");
}

// An instruction that moves nothing, up to its semicolon.
void Reader::idle() {
    const bool known = std::any_of(kIdle.begin(), kIdle.end(),
                                   [&](std::string_view word) { return token_.is_word(word); });
    if (!known) {
        not_understood();
    }
    for (next(); !token_.is(";"); next()) {
        static constexpr std::array<std::string_view, 6> kMarks = {",", "\\", ":=", "-", "[", "]"};
        const bool taken = token_.kind == Kind::Word || token_.kind == Kind::Number ||
                           token_.kind == Kind::Text ||
                           std::any_of(kMarks.begin(), kMarks.end(),
                                       [&](std::string_view mark) { return token_.is(mark); });
        if (!taken) {
            not_understood();
        }
    }
}

void Reader::own_line() {
    owned_ = true;
    next();
    while (token_.kind != Kind::End) {
        idle();
        expect_mark(";");
    }
    if (blocks_.ties_on()) {
        line_.fail("nc.tie_on", "it ties the fibre on or places pins");
    }
}

// MoveAbsJ [[..],[..]]\NoEOffs,v1000\T:=0.12,corner,tool0;
void Reader::move() {
    RobotMove to = target();
    if (token_.is("\\")) {
        next();
        expect_word("noeoffs");
    }
    expect_mark(",");
    speed(to);
    expect_mark(",");
    zone(to);
    expect_mark(",");
    (void)name();
    while (token_.is("\\")) {
        next();
        if (!token_.is_word("wobj") && !token_.is_word("tload")) {
            not_understood();
        }
        next();
        expect_mark(":=");
        (void)name();
    }
    blocks_.move(std::move(to));
}

RobotMove Reader::target() {
    RobotMove to = blocks_.next(token_.line);
    next();
    expect_mark("[");
    std::array<std::optional<std::size_t>, kArmAxes> arm;
    std::copy(axes_.arm.begin(), axes_.arm.end(), arm.begin());
    targets(arm, to);
    expect_mark(",");
    targets(axes_.external, to);
    expect_mark("]");
    return to;
}

// [..], a number for each.
void Reader::targets(std::span<const std::optional<std::size_t>> joints, RobotMove& to) {
    char before = '[';
    for (std::size_t i = 0; i < joints.size(); ++i) {
        expect_mark(std::string_view(&before, 1));
        before = ',';
        const char letter = joints[i] ? blocks_.axes()[*joints[i]].letter : '?';
        const std::optional<std::int64_t> nano = position(letter);
        if (joints[i].has_value() != nano.has_value()) {
            line_.fail("nc.no_axis",
                       joints[i] ? std::string("axis ") + letter + " has no position"
                                 : std::string(kRapidLanguage.external[i]) +
                                       " has a position, and the machine \"" + machine_.name +
                                       "\" has no such axis; is it the machine of this program?");
        }
        if (nano) {
            to.nano[*joints[i]] = *nano;
        }
    }
    expect_mark("]");
}

// Nothing for 9E9.
std::optional<std::int64_t> Reader::position(char letter) {
    const bool negative = token_.is("-");
    if (negative || token_.is("+")) {
        next();
    }
    if (token_.kind != Kind::Number) {
        not_understood();
    }
    const std::string_view text = token_.text;
    std::optional<std::int64_t> nano;
    if (text.find_first_of("eE") == std::string_view::npos) {
        nano = line_.nano({letter, text});
        *nano = negative ? -*nano : *nano;
    } else {
        if (token_.value() != kNoAxis || negative) {
            line_.bad_number({letter, text});
        }
    }
    next();
    return nano;
}

void Reader::speed(RobotMove& to) {
    (void)name();
    if (token_.is("\\")) {
        next();
        expect_word("t");
        expect_mark(":=");
        to.duration_s = seconds();
        next();
    }
}

double Reader::seconds() {
    if (token_.kind != Kind::Number) {
        not_understood();
    }
    const std::optional<double> value = token_.value();
    if (!value || !(*value > 0.0) || !std::isfinite(*value)) {
        line_.fail("nc.feed", "\\T:=" + std::string(token_.text) + " is not a time above 0");
    }
    return *value;
}

void Reader::zone(RobotMove& to) {
    const RapidToken token = token_;
    const std::string zone = lower_case(name());
    to.stops = zone == "fine";
    const bool known = to.stops || corners_.count(zone) > 0 ||
                       std::find(kZones.begin(), kZones.end(), zone) != kZones.end();
    if (!known) {
        line_.number = token.line;
        line_.fail("nc.not_understood", "\"" + std::string(token.text) +
                                            "\" is not a zone that is flown by: declare it with "
                                            "FALSE, or write one from z0 to z200");
    }
}

}  // namespace

BlockList read_rapid(std::string_view text, const std::string& file, const Machine& machine) {
    return Reader(text, file, machine).program();
}

void check_own_rapid_line(const Machine& machine, const std::string& line) {
    check_robot_line(machine, line, [&] { Reader(line, machine.name, machine).own_line(); });
}

}  // namespace meshwind
