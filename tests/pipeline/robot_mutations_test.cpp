// One change in a program for a robot is seen, and its block named, as mutations_test.cpp has it
// for G-code: MESHWIND_COUNT random changes (40) from MESHWIND_SEED (1) of a pipe's program, and
// every change of its frame that is listed here. Positions are absolute: a block left out or
// exchanged is another way to the same place.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/released_program.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

using test::Lines;

struct Released : test::ReleasedProgram {
    std::vector<std::size_t> blocks{};  // lines with positions of blocks, from 0
    std::vector<std::size_t> times{};   // those with their times
};

// The first three angles of a position of TP.
std::size_t line_of_position(const Lines& lines, std::size_t number) {
    const auto at = std::find(lines.begin(), lines.end(), "P[" + std::to_string(number) + "]{");
    return static_cast<std::size_t>(at - lines.begin()) + 3;
}

Released release(const std::string& dialect) {
    Machine machine = test::shipped("robot_winder");
    machine.controller.dialect = dialect;
    const Job job = test::quick_job();
    Released released{test::released_program(test::small_pipe(), machine, job)};
    const BlockList list =
        released.setup.dialect->read(test::text_of(released.lines), released.file, machine);
    for (std::size_t b = 1; b < list.blocks.size(); ++b) {
        const auto line = static_cast<std::size_t>(list.blocks[b].line) - 1;
        // In TP the block's own line has the time alone.
        released.blocks.push_back(dialect == "tp" ? line_of_position(released.lines, b + 1) : line);
        // In KRL the next line; a comment never stands between.
        released.times.push_back(dialect == "krl" ? line + 1 : line);
    }
    return released;
}

// Where the numbers with a point stand in a line.
struct Number {
    std::size_t first = 0;
    std::size_t size = 0;
};

std::vector<Number> numbers_of(const std::string& line) {
    std::vector<Number> numbers;
    for (std::size_t i = 0; i < line.size();) {
        const std::size_t end = std::min(line.find_first_not_of("-.0123456789", i), line.size());
        if (line.substr(i, end - i).find('.') != std::string::npos) {
            numbers.push_back({i, end - i});
        }
        i = std::max(i + 1, end);
    }
    return numbers;
}

class Mutator {
public:
    Mutator(const Released& program, unsigned seed) : program_(program), random_(seed) {}

    struct Change {
        std::size_t block = 0;  // from 0
        std::size_t line = 0;   // from 0
    };

    // Changes one block.
    Change next(unsigned number, Lines& lines, std::string& what) {
        for (;;) {
            lines = program_.lines;
            const std::size_t at = random_() % program_.blocks.size();
            const bool of_time = number % 9 == 8;
            const std::size_t line = of_time ? program_.times[at] : program_.blocks[at];
            const bool last = at + 1 == program_.blocks.size();
            what = lines[line];
            if (change(number % 9, lines, line, last ? line : program_.blocks[at + 1])) {
                what += " -> " + (line < lines.size() ? lines[line] : std::string());
                return {at, line};
            }
        }
    }

private:
    bool change(unsigned kind, Lines& lines, std::size_t line, std::size_t next) {
        const auto at = lines.begin() + static_cast<std::ptrdiff_t>(line);
        std::string& text = lines[line];
        switch (kind) {
            case 0:
                return move(text, 5.0);
            case 1:
                return move(text, 0.01);
            case 2:
                lines.erase(at);
                return true;
            case 3:
                lines.insert(at, std::string(text));
                return true;
            case 4:
                std::swap(text, lines[next]);
                return next != line && text != lines[next];
            case 5:
                return sign(text);
            case 6:
                text.resize(1 + random_() % (text.size() - 2));
                return true;
            case 7:
                return digits(text);
            default:
                return time(text);
        }
    }

    // The last number, by a hundredth or more.
    bool time(std::string& text) {
        static const std::vector<double> kTimes = {0.1, 0.5, 0.99, 1.01, 2.0, 10.0};
        const Number number = time_of(text);
        const std::string before = text;
        const double value = std::strtod(text.c_str() + number.first, nullptr);
        const bool whole = before.find('.', number.first) >= number.first + number.size;
        char now[40];
        (void)std::snprintf(now, sizeof now, whole ? "%.0f" : "%.9f",
                            value * kTimes[random_() % kTimes.size()]);
        text.replace(number.first, number.size, now);
        return text != before;
    }

    // The number before its unit, or the last one.
    static Number time_of(const std::string& text) {
        const std::size_t unit = text.find("msec");
        if (unit == std::string::npos) {
            return numbers_of(text).back();
        }
        const std::size_t first = text.rfind(' ', unit) + 1;
        return {first, unit - first};
    }

    // A number of the line.
    Number pick(const std::string& text) {
        const std::vector<Number> numbers = numbers_of(text);
        return numbers[random_() % numbers.size()];
    }

    bool move(std::string& text, double most) {
        const Number number = pick(text);
        const double value = std::strtod(text.c_str() + number.first, nullptr);
        const double by =
            (random_() % 2 == 0 ? 1e-3 : -1e-3) *
            (1.0 + std::floor(1e3 * most * static_cast<double>(random_() % 1000) / 1000.0));
        char now[40];
        (void)std::snprintf(now, sizeof now, "%.3f", value + by);
        text.replace(number.first, number.size, now);
        return std::strtod(now, nullptr) > 0.0 || number.first < numbers_of(text).back().first;
    }

    bool sign(std::string& text) {
        const Number number = pick(text);
        const bool minus = text[number.first] == '-';
        text.replace(number.first, minus ? 1 : 0, minus ? "" : "-");
        return std::strtod(text.c_str() + number.first, nullptr) != 0.0;
    }

    bool digits(std::string& text) {
        const Number number = pick(text);
        for (std::size_t i = number.first; i + 1 < number.first + number.size; ++i) {
            if (std::isdigit(text[i]) != 0 && std::isdigit(text[i + 1]) != 0 &&
                text[i] != text[i + 1]) {
                std::swap(text[i], text[i + 1]);
                return true;
            }
        }
        return false;
    }

    const Released& program_;
    std::mt19937 random_;
};

// The line itself or a neighbour (comments stand between some, and angles of TP begin three lines
// behind their position's name). A share of a time block of KRL
// changes the times of all its segments, from the first on.
bool is_beside(const Lines& lines, std::int32_t line, std::int32_t named) {
    if (std::abs(named - line) <= 3) {
        return true;
    }
    bool one_block = named > 0 && named < line;
    for (std::int32_t i = named; one_block && i < line; ++i) {
        one_block = lines[static_cast<std::size_t>(i) - 1].find("ENDSPLINE") == std::string::npos;
    }
    return one_block && lines[static_cast<std::size_t>(line) - 1].find("PART") != std::string::npos;
}

void expect_random_changes_seen(const Released& program) {
    const unsigned seed = test::from_environment("MESHWIND_SEED", 1);
    const unsigned count = test::from_environment("MESHWIND_COUNT", 40);
    Mutator mutator(program, seed);
    for (unsigned i = 0; i < count; ++i) {
        Lines lines;
        std::string what;
        const Mutator::Change change = mutator.next(i, lines, what);
        const auto line = static_cast<std::int32_t>(change.line) + 1;
        const auto of_block = static_cast<std::int32_t>(program.times[change.block]) + 1;
        const test::Answer answer = test::answer_of(program, test::text_of(lines));
        EXPECT_TRUE(answer.seen &&
                    (is_beside(lines, line, answer.line) || std::abs(answer.line - of_block) <= 2))
            << "seed " << seed << ", change " << i << " in line " << line << ": " << what
            << "; seen by " << answer.by << ", which names line " << answer.line;
        EXPECT_TRUE(test::digest_sees(program, test::text_of(lines))) << what;
    }
}

// A change of the frame: the first line that has `what` becomes `by`, or goes.
struct FrameChange {
    std::string what;
    std::string by;
};

void expect_frame_changes_seen(const Released& program, const std::vector<FrameChange>& changes) {
    for (const FrameChange& change : changes) {
        SCOPED_TRACE(change.what + " -> " + change.by);
        std::string text = test::text_of(program.lines);
        const std::size_t at = text.find(change.what);
        ASSERT_NE(at, std::string::npos);
        text.replace(at, change.what.size(), change.by);
        EXPECT_TRUE(test::answer_of(program, text).seen);
        EXPECT_TRUE(test::digest_sees(program, text));
    }
}

TEST(RobotMutations, Rapid) {
    const Released program = release("rapid");
    EXPECT_FALSE(test::answer_of(program, test::text_of(program.lines)).seen);
    EXPECT_FALSE(test::digest_sees(program, test::text_of(program.lines)));
    const std::string first = program.lines[program.blocks.front()];
    const std::string start = first.substr(0, first.find("v1000")) + "approach,fine,tool0;\n";
    expect_frame_changes_seen(program, {{"Stop;\n", ""},
                                        {"Stop;\n", "Stop;\n" + start},
                                        {"FALSE", "TRUE"},
                                        {"approach,fine", "approach\\T:=5,fine"},
                                        {"corner,tool0;", "fine,tool0;"},
                                        {"tie on at X30.0", "tie on at X33.0"},
                                        {"! tie on", "! fasten"},
                                        {"PROC main()", "PROC main()\nWaitTime 1;"},
                                        {"ENDPROC", start + "ENDPROC"},
                                        {"ENDMODULE\n", ""}});
    expect_random_changes_seen(program);
}

TEST(RobotMutations, Krl) {
    const Released program = release("krl");
    EXPECT_FALSE(test::answer_of(program, test::text_of(program.lines)).seen);
    EXPECT_FALSE(test::digest_sees(program, test::text_of(program.lines)));
    const std::string first = program.lines[program.blocks.front()];
    const std::string start = "PTP" + first.substr(4) + "\n";
    expect_frame_changes_seen(program, {{"HALT\n", ""},
                                        {"HALT\n", "HALT\n" + start},
                                        {" C_SPL", ""},
                                        {"$APO.CPTP=50", "$APO.CPTP=5"},
                                        {"BAS(#VEL_PTP,100)\n", ""},
                                        {"tie on at X30.0", "tie on at X33.0"},
                                        {"; tie on", "; fasten"},
                                        {"PTP_SPLINE", "SPLINE"},
                                        {"TIME_BLOCK START", "WAIT SEC 1\nTIME_BLOCK START"},
                                        {"TIME_BLOCK END=", "TIME_BLOCK END=1"},
                                        {"ENDSPLINE\nEND", "ENDSPLINE\n" + start + "END"},
                                        {"ENDSPLINE\nEND\n", "ENDSPLINE\n"}});
    expect_random_changes_seen(program);
}

TEST(RobotMutations, Tp) {
    const Released program = release("tp");
    EXPECT_FALSE(test::answer_of(program, test::text_of(program.lines)).seen);
    EXPECT_FALSE(test::digest_sees(program, test::text_of(program.lines)));
    const std::string start = "    :J P[2] 10% FINE ;\n";
    expect_frame_changes_seen(program, {{"PAUSE ;\n", " ;\n"},
                                        {"PAUSE ;\n", "PAUSE ;\n" + start},
                                        {"CNT100", "FINE"},
                                        {"10% FINE", "5sec FINE"},
                                        {"J P[3] ", "J P[4] "},
                                        {"UT : 1", "UT : 2"},
                                        {"1,*,*,*,*", "1,1,*,*,*"},
                                        {"tie on at X30.0", "tie on at X33.0"},
                                        {"!tie on", "!fasten"},
                                        {"UTOOL_NUM=1 ;", "UTOOL_NUM=1 ;\n    :  WAIT 1.00(sec) ;"},
                                        {"/POS\n", start + "/POS\n"},
                                        {"/END\n", ""}});
    expect_random_changes_seen(program);
}

}  // namespace
}  // namespace meshwind
