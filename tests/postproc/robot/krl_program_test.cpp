// KRL of the main job: what is written for KUKA's controllers, and what is refused when it is read.
#include "postproc/robot/krl_program.h"

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "postproc/robot/krl_reader.h"
#include "tests/support/block_lists.h"
#include "tests/support/dialect_lists.h"

namespace meshwind {
namespace {

using test::add;
using test::empty_list;
using test::machine_for;

const std::string kFirst =
    "BAS(#INITMOV,0)\n$ADVANCE=3\n$APO.CPTP=50\n$APO.CDIS=5\nBAS(#VEL_PTP,10)\nBAS(#ACC_PTP,20)\n";
const std::string kWinding = "BAS(#VEL_PTP,100)\nBAS(#ACC_PTP,100)\n";

std::string at(const std::string& x, const std::string& word = "SPTP") {
    return word + " {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0,E1 " + x + "}\n";
}

std::string point(const std::string& x, const std::string& part = "0.5") {
    return at(x) + "TIME_BLOCK PART=" + part + "\n";
}

// Lines 1 to 13; a spline block opens in 12.
const std::string kStart = "&ACCESS RVP\nDEF m( )\n" + kFirst + at("0", "PTP") + kWinding +
                           "PTP_SPLINE\nTIME_BLOCK START\n";
const std::string kEnd = "ENDSPLINE\nEND\n";

std::string refusal(const std::string& text) {
    try {
        (void)Krl().read(text, "p", machine_for("krl"));
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.code() + " " + error.place();
    }
    return "accepted";
}

// With these lines behind the first segment, which are the time's end as well.
std::string refused_lines(const std::string& lines) {
    return refusal(std::string(kStart).append(point("1.5")).append(lines).append(kEnd));
}

TEST(Krl, WritesThisProgram) {
    const Machine machine = machine_for("krl");
    BlockList list = empty_list(machine);
    add(list, {-5015, 3113, -29088, 0, 0, 0, 43004}, 0.0);
    add(list, {-26711, 2391, -29119, 1, 0, 0, 43495}, 0.0865582, 0);
    add(list, {-26711, 2391, -29119, 1, 0, -1, 43495}, 2.0, 1);
    EXPECT_EQ(
        Krl().write(machine, list, {.version = "test"}),
        "&ACCESS RVP\nDEF program( )\n; meshwind test\n; machine: Robot in front of a spindle\n"
        "; fibre: 0.000 m\n; time: 2.1 s\n; blocks: 2\n"
        "; axes 1 to 6: A B C U V W; external: X is E1\n" +
            kFirst +
            "; approach: all axes move together;\n"
            "; bring the eye clear of the mandrel by hand before the start\n"
            "PTP {A1 3.113,A2 -29.088,A3 0.000,A4 0.000,A5 0.000,A6 43.004,E1 -5.015}\n"
            "; tie the fibre on at the landing point, then start again\nHALT\n" +
            kWinding +
            "PTP_SPLINE\nTIME_BLOCK START\n; course 0\n"
            "SPTP {A1 2.391,A2 -29.119,A3 0.001,A4 0.000,A5 0.000,A6 43.495,E1 -26.711}\n"
            "TIME_BLOCK PART=0.0865582\n; course 1\n"
            "SPTP {A1 2.391,A2 -29.119,A3 0.001,A4 0.000,A5 -0.001,A6 43.495,E1 -26.711}\n"
            "TIME_BLOCK PART=2\nTIME_BLOCK END=2.0865582\nENDSPLINE\nEND\n");
}

// Spline blocks hold so many segments, flow into one another, and their times are the sums of the
// shares to the last digit, by an own reading of the text.
TEST(Krl, SplineBlocksFlowIntoOneAnother) {
    const Machine machine = machine_for("krl");
    for (const int blocks : {1, 49, 50, 51, 1234}) {
        SCOPED_TRACE(blocks);
        const BlockList list = test::random_list(machine, 3, blocks);
        const std::string text = Krl().write(machine, list, {});
        std::size_t segments = 0;
        std::size_t splines = 0;
        std::int64_t sum = 0;
        double whole_s = 0.0;
        for (const std::string& line : test::split_lines(text)) {
            if (line.rfind("TIME_BLOCK PART=", 0) == 0) {
                ++segments;
                sum += std::llround(1e9L * std::strtold(line.c_str() + 16, nullptr));
            } else if (line.rfind("TIME_BLOCK END=", 0) == 0) {
                EXPECT_EQ(sum, std::llround(1e9L * std::strtold(line.c_str() + 15, nullptr)));
                EXPECT_LE(segments, kKrlSegments);
                whole_s += 1e-9 * static_cast<double>(sum);
            } else if (line.rfind("ENDSPLINE", 0) == 0) {
                ++splines;
                const bool last = splines * kKrlSegments >= static_cast<std::size_t>(blocks);
                EXPECT_EQ(line, last ? "ENDSPLINE" : "ENDSPLINE C_SPL");
                segments = 0;
                sum = 0;
            }
        }
        EXPECT_EQ(splines, (static_cast<std::size_t>(blocks) + kKrlSegments - 1) / kKrlSegments);
        EXPECT_NEAR(whole_s / list.duration_s(), 1.0, 1e-6);  // six digits of each share
        EXPECT_EQ(Krl().read(text, "p", machine).nano, list.nano);
    }
}

TEST(Krl, HeadAndApproachAreRead) {
    const Machine machine = machine_for("krl");
    const BlockList planned = test::small_program(machine);
    const BlockList read = Krl().read(
        Krl().write(machine, planned, {.version = "test", .code_digest = "sha256/128 02"}), "p",
        machine);
    EXPECT_TRUE(read.head->by_meshwind);
    EXPECT_EQ(read.head->code_digest, "sha256/128 02");
    ASSERT_EQ(read.head->approach.size(), 1U);
    EXPECT_EQ(read.head->approach.front().nano,
              std::vector<std::int64_t>(planned.row(0).begin(), planned.row(0).end()));
    EXPECT_EQ(read.head->stop_line, read.head->approach.front().line + 2);
}

TEST(Krl, OwnLines) {
    const auto refused = [](const std::string& line) {
        Machine machine = machine_for("krl");
        machine.controller.header = {line};
        machine.controller.footer = {line};
        try {
            Krl().check(machine);
        } catch (const InputError& error) {
            EXPECT_EQ(error.code(), "dialect.header_line");
            return true;
        }
        return false;
    };
    for (const char* line : {"", "; {mandrel}", "$TOOL=TOOL_DATA[1]", "$out[3] = true ; on",
                             "BAS (#TOOL,1)", "$ANOUT[1]=0.25", "$LOAD=LOAD_DATA[2]"}) {
        EXPECT_FALSE(refused(line)) << line;
    }
    for (const char* line : {"PTP HOME", "WAIT SEC 1", "END", "HALT", "$VEL.CP=1", "$OV_PRO=50",
                             "BAS(#VEL_PTP,5)", "; tie on", "SPTP XP1", "&ACCESS RVP"}) {
        EXPECT_TRUE(refused(line)) << line;
    }
}

TEST(KrlRead, NamesTheLineOfWhatItRefuses) {
    const std::string good = kStart + point("1.5") + point("3") + "TIME_BLOCK END=1\n" + kEnd;
    ASSERT_EQ(refusal(good), "accepted");
    const BlockList list = Krl().read(good, "p", machine_for("krl"));
    EXPECT_EQ(list.blocks.size(), 3U);
    EXPECT_EQ(list.value(2, 0), 3.0);
    EXPECT_EQ(list.blocks[1].line, 14);
    EXPECT_EQ(list.blocks[2].duration_s, 0.5);
    const std::string end = "TIME_BLOCK END=1\n";
    EXPECT_EQ(refused_lines(end), "accepted");
    const struct {
        std::string lines;
        const char* said;
    } cases[] = {
        {point("1.5") + end, "nc.feed p:16"},
        {point("1.0005") + end, "nc.resolution p:16"},
        {point("7200001.6") + end, "nc.too_far p:16"},
        {point("1e2") + end, "nc.not_understood p:16"},
        {point("1.2.3") + end, "nc.number p:16"},
        {point("") + end, "nc.not_understood p:16"},
        {point("2", "0") + end, "nc.feed p:17"},
        {point("2", "-1") + end, "nc.feed p:17"},
        {point("2", "x") + end, "nc.not_understood p:17"},
        {point("2", "1 s") + end, "nc.not_understood p:17"},
        {at("2") + end, "nc.feed p:17"},
        {at("2") + at("3") + end, "nc.feed p:17"},
        {"TIME_BLOCK PART=1\n" + end, "nc.feed p:16"},
        {end + point("2"), "nc.feed p:17"},
        {end + end, "nc.feed p:17"},
        {"", "nc.feed p:16"},
        {"SLIN {X 0}\n" + end, "nc.not_understood p:16"},
        {"HALT\n" + end, "nc.not_understood p:16"},
        {"$OUT[1]=TRUE\n" + end, "nc.not_understood p:16"},
        {"SPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}\n" + end, "nc.no_axis p:16"},
        {"SPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0,E2 1}\n" + end, "nc.no_axis p:16"},
        {"SPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A1 0,E1 1}\n" + end, "nc.word_twice p:16"},
        {"SPTP {A10,A2 0,A3 0,A4 0,A5 0,A6 0,E1 1}\n" + end, "nc.not_understood p:16"},
        {"SPTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0,E1 1} C_PTP\n" + end, "nc.not_understood p:16"},
        {"SPTP XP1\n" + end, "nc.not_understood p:16"},
        {"; tie on\n" + end, "nc.tie_on p:16"},
        {"; course 5\n  sptp { a1 0 , A2 0,A3 0,A4 0,A5 0,A6 0,e1 -2.5 } ; words\n"
         "Time_Block Part = .5\n" +
             end,
         "accepted"},
        {end + "ENDSPLINE C_SPL\nPTP_SPLINE\nTIME_BLOCK START\n" + point("4") + end, "accepted"},
        {end + "ENDSPLINE\nPTP_SPLINE\nTIME_BLOCK START\n" + point("4") + end,
         "nc.stop_point p:14"},
        {end + "ENDSPLINE C_SPL\n" + at("9", "PTP") + "PTP_SPLINE\nTIME_BLOCK START\n" +
             point("4") + end,
         "nc.rapid p:18"},
        {end + "ENDSPLINE C_SPL\nPTP_SPLINE\n" + point("4") + end, "nc.not_understood p:19"},
        {end + "ENDSPLINE C_DIS\nPTP_SPLINE\n" + point("4") + end, "nc.not_understood p:17"},
    };
    for (const auto& c : cases) {
        EXPECT_EQ(refused_lines(c.lines), c.said) << c.lines;
    }
    EXPECT_EQ(refusal(kStart + point("1.5") + end + "ENDSPLINE\n"), "nc.no_end p:17");
    EXPECT_EQ(refusal(good + "; words\n\n"), "accepted");
    EXPECT_EQ(refusal(good + "HALT\n"), "nc.not_understood p:21");
    EXPECT_EQ(refusal(""), "nc.no_end p:0");
    EXPECT_EQ(refusal("DEF m( )\n" + kFirst + at("0", "PTP") + "END\n"), "nc.no_motion p:9");
    EXPECT_EQ(refusal("DEF m( )\n$ADVANCE=3\n"), "nc.not_understood p:2");
    EXPECT_EQ(refusal("DEF m\n"), "nc.not_understood p:1");
    EXPECT_EQ(refusal("DEF m( )\n" + kFirst + kWinding + "PTP_SPLINE\nTIME_BLOCK START\n" +
                      point("1") + end + kEnd),
              "nc.unknown_start p:12");
    EXPECT_EQ(refusal("DEF m( )\n" + kFirst + at("0", "PTP") + "PTP_SPLINE\n"),
              "nc.not_understood p:9");
}

// The time of a spline block rules; shares say how it is parted.
TEST(KrlRead, SharesPartTheTimeOfTheirSplineBlock) {
    const BlockList list =
        Krl().read(kStart + point("1.5", "30") + point("3", "70") + "TIME_BLOCK END=2\n" + kEnd,
                   "p", machine_for("krl"));
    EXPECT_DOUBLE_EQ(list.blocks[1].duration_s, 0.6);
    EXPECT_DOUBLE_EQ(list.blocks[2].duration_s, 1.4);
    std::string huge;
    for (int i = 1; i < 40; ++i) {
        huge += point(std::to_string(i), "999999999");
    }
    EXPECT_EQ(refusal(kStart + huge + "TIME_BLOCK END=2\n" + kEnd), "nc.number p:92");
}

// A line left out or doubled, or a number of it changed, is refused or read as something else.
TEST(KrlRead, EveryChangeOfALineIsSeen) {
    const Machine machine = machine_for("krl");
    const std::string text = Krl().write(machine, test::small_program(machine),
                                         {.tie_on_mm = Eigen::Vector3d(70.0, 0.0, -1.5)});
    const std::vector<std::string> lines = test::split_lines(text);
    const std::string code = Krl().code_of(text, "p");
    const BlockList whole = Krl().read(text, "p", machine);
    const auto is_seen = [&](const std::string& changed) {
        EXPECT_NE(Krl().code_of(changed, "p"), code);
        return test::reads_otherwise(Krl(), machine, changed, whole);
    };
    std::size_t begin = 0;
    for (const std::string& line : lines) {
        const std::size_t size = line.size() + 1;
        if (line[0] != ';' && line[0] != '&') {
            SCOPED_TRACE(line);
            EXPECT_TRUE(is_seen(std::string(text).erase(begin, size)));
            // A second move to the start, or stop, leads to where the first did.
            EXPECT_TRUE(line.rfind("PTP {", 0) == 0 || line == "HALT" ||
                        is_seen(std::string(text).insert(begin, line + "\n")));
            const std::size_t point = line.find('.');
            if (point != std::string::npos && line[0] != '$') {
                std::string moved = text;
                moved[begin + point + 1] = moved[begin + point + 1] == '7' ? '3' : '7';
                EXPECT_TRUE(is_seen(moved));
            }
        }
        begin += size;
    }
}

}  // namespace
}  // namespace meshwind
