// Subprograms and repeats of LinuxCNC programs: what is run, and what is refused where. How the
// interpreter takes these forms was measured; linuxcnc_oracle_test.cpp repeats that.
#include "postproc/nc/linuxcnc_flow.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "postproc/nc/linuxcnc.h"
#include "tests/support/block_lists.h"

namespace meshwind {
namespace {

const std::string kStart = "G21 G90\nG0 A0 B0 C0\nG0 X0 Y0 Z0\nM0\nG91 G93\n";

using test::six_axis;

// Moves along X by 1, 2, .. 9 as digits, so that "112" is what a program ran.
std::string moves(const std::string& text) {
    const Machine machine = six_axis();
    const BlockList list = LinuxCnc().read(text, "p.ngc", machine);
    const std::size_t x = *machine.joint_of('X');
    std::string digits;
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        digits += std::to_string(static_cast<int>(list.value(i, x) - list.value(i - 1, x)));
    }
    return digits;
}

std::string x(int length) {
    return "G1 X" + std::to_string(length) + " F60\n";
}

std::string refusal(const std::string& text) {
    try {
        (void)LinuxCnc().read(test::as_ours(text), "p.ngc", six_axis());
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.code() + " " + error.place();
    }
    return "accepted";
}

TEST(LinuxCncFlow, SubprogramsByNumberStandBehindTheEnd) {
    const std::string subs =
        "O100 (title)\n" + x(1) + "M98 P0101 L2\nN7 M99\nO0101\n" + x(2) + "M99\n";
    EXPECT_EQ(moves(kStart + "M98 P100\nM2\n" + subs), "122");
    EXPECT_EQ(moves(kStart + x(9) + "m98p100l2 (twice)\n" + x(8) + "M30\n" + subs), "91221228");
    EXPECT_EQ(moves(kStart + x(9) + "M98 P100. L+1.0\nM2\n" + subs), "9122");
    EXPECT_EQ(moves("%\nO1 (number of the program)\n" + kStart + "M98 P101\nM2\n" + subs + "%\nx("),
              "2");
    EXPECT_EQ(moves("O101\n" + kStart + "M98 P101\nM2\n" + subs), "2");
    EXPECT_EQ(moves(kStart + x(3) + "M2\nnot read (\n" + x(1) + "M98 P7\n" + subs), "3");
    EXPECT_EQ(moves(kStart + x(3) + "M98 P5\n" + x(4) + "M2\nO5\n" + x(1) + "M2\nM99\n"), "31");
}

TEST(LinuxCncFlow, SubprogramsByWordStandAnywhere) {
    const std::string sub = "o<Two> sub\n" + x(2) + "O < t wo >ENDSUB ; end\n";
    EXPECT_EQ(moves(sub + kStart + "o<two> call\nM2\n"), "2");
    EXPECT_EQ(moves(kStart + "N5 o<two> call\nM2\n" + sub), "2");
    EXPECT_EQ(moves(kStart + x(1) + sub + x(3) + "o<two>call\nM2\n"), "132");
    EXPECT_EQ(moves(sub + "o5 sub\no<two> call\no005 endsub\n" + kStart + "o5 call\no5 call\nM2\n"),
              "22");
}

TEST(LinuxCncFlow, RepeatsRunAsOftenAsTheySay) {
    EXPECT_EQ(moves(kStart + "o1 repeat [2]\n" + x(1) + "o2 repeat [ 3 ]\n" + x(2) +
                    "o2 endrepeat\no1 endrepeat\nM2\n"),
              "12221222");
    EXPECT_EQ(moves(kStart + x(1) + "o1 repeat [0]\n" + x(2) + "o1 endrepeat\nM2\n"), "1");
    // Repeats of one number in different subprograms.
    EXPECT_EQ(moves("o8 sub\no1 repeat [2]\n" + x(2) + "o1 endrepeat\no8 endsub\n" + kStart +
                    "o1 repeat [2]\no8 call\no1 endrepeat\nM2\n"),
              "2222");
}

TEST(LinuxCncFlow, RepeatedBlocksShareTheirLineAndCarryTheCourseMarks) {
    const BlockList list =
        LinuxCnc().read(kStart + x(1) + "M98 P1 L2\n" + x(3) + "M2\nO1 (course 4)\n" + x(1) +
                            "(course 5)\n" + x(2) + "M99\n",
                        "p.ngc", six_axis());
    std::vector<int> lines;
    std::vector<int> pieces;
    for (const Block& block : list.blocks) {
        lines.push_back(block.line);
        pieces.push_back(block.piece);
    }
    EXPECT_EQ(lines, (std::vector<int>{6, 6, 11, 13, 11, 13, 8}));
    EXPECT_EQ(pieces, (std::vector<int>{-1, -1, 4, 5, 4, 5, 5}));
}

TEST(LinuxCncFlow, RefusesWhatCannotBeFollowed) {
    const std::string sub = "O5\n" + x(1) + "M99\n";
    EXPECT_EQ(refusal(kStart + "M98 P6\nM2\n" + sub), "nc.no_subprogram p.ngc:6");
    EXPECT_EQ(refusal(kStart + "o5 call\nM2\n" + sub), "nc.no_subprogram p.ngc:6");
    EXPECT_EQ(refusal(kStart + "M98 P5\nM2\no5 sub\n" + x(1) + "o5 endsub\n"),
              "nc.no_subprogram p.ngc:6");
    EXPECT_EQ(refusal(kStart + "M98 P5\nM2\n" + sub + sub), "nc.label_twice p.ngc:11");
    EXPECT_EQ(refusal("o5 sub\no5 endsub\n" + kStart + "M98 P5\nM2\n" + sub),
              "nc.label_twice p.ngc:10");
    EXPECT_EQ(refusal(kStart + "M98 P5\nM2\nO5\n" + x(1) + "M98 P5\nM99\n"),
              "nc.recursion p.ngc:10");
    EXPECT_EQ(refusal(kStart + "M98 P5\nM2\nO5\nM98 P6\nM99\nO6\n" + x(1) + "M98 P5\nM99\n"),
              "nc.recursion p.ngc:13");
    EXPECT_EQ(refusal(kStart + "o5 call\no5 sub\n" + x(1) + "o5 endsub\nM2\n"),
              "nc.subprogram_place p.ngc:7");
    EXPECT_EQ(refusal(kStart + "M98 P5\nM2\nO6\n" + x(1) + "M99\nO5\nM98 P6\nM99\n"),
              "nc.subprogram_place p.ngc:12");
}

TEST(LinuxCncFlow, RefusesWhatIsNotClosed) {
    EXPECT_EQ(refusal(kStart + "M98 P5\nM2\nO5\n" + x(1)), "nc.not_closed p.ngc:8");
    EXPECT_EQ(refusal(kStart + "M98 P5\nM2\nO5\n" + x(1) + "O6\n" + x(2) + "M99\n"),
              "nc.not_closed p.ngc:10");
    EXPECT_EQ(refusal(kStart + "O5\n" + x(1) + "M99\nM98 P5\nM2\n"), "nc.not_closed p.ngc:8");
    EXPECT_EQ(refusal("o5 sub\n" + kStart + x(1) + "M2\n"), "nc.not_closed p.ngc:1");
    EXPECT_EQ(refusal("o5 sub\no6 sub\no6 endsub\no5 endsub\n" + kStart + "M2\n"),
              "nc.not_closed p.ngc:2");
    EXPECT_EQ(refusal("o5 sub\n" + x(1) + "M99\no5 endsub\n" + kStart + "M2\n"),
              "nc.not_closed p.ngc:3");
    EXPECT_EQ(refusal(kStart + "o5 repeat [2]\n" + x(1) + "M2\n"), "nc.not_closed p.ngc:6");
    EXPECT_EQ(refusal(kStart + x(1) + "o5 endrepeat\nM2\n"), "nc.not_closed p.ngc:7");
    EXPECT_EQ(refusal(kStart + "o1 repeat [2]\no2 repeat [2]\n" + x(1) +
                      "o1 endrepeat\no2 endrepeat\nM2\n"),
              "nc.not_closed p.ngc:9");
    EXPECT_EQ(refusal(kStart + "o1 repeat [2]\n" + x(1) + "o1 endrepeat\no1 repeat [2]\n" + x(1) +
                      "o1 endrepeat\nM2\n"),
              "nc.label_twice p.ngc:9");
}

TEST(LinuxCncFlow, RefusesArgumentsExpressionsAndConditions) {
    const std::string sub = "o5 sub\n" + x(1) + "o5 endsub\n";
    for (const char* line : {"o5 call [1]",
                             "o5 repeat [1+1]",
                             "o5 repeat [#1]",
                             "o5 repeat [-1]",
                             "o5 repeat [2.5]",
                             "o5 repeat 2",
                             "o5 repeat",
                             "o5 if [1 EQ 1]",
                             "o5 while [1]",
                             "o5 do",
                             "o5 return",
                             "o5 endsub [1]",
                             "o#1 call",
                             "o<open call",
                             "o",
                             "o5 wind",
                             "M98",
                             "M98 L2",
                             "M98 P5 L0",
                             "M98 P5 X1",
                             "M98 P5 G91",
                             "M3 M98 P5",
                             "M98 M98 P5"}) {
        EXPECT_EQ(refusal(sub + kStart + line + "\nM2\n"), "nc.o_word p.ngc:9") << line;
    }
    for (const char* line : {"M98 P5.5", "M98 P-5", "M98 P5 L2.5", "M98 P5 L-2", "M98 P"}) {
        EXPECT_EQ(refusal(sub + kStart + line + "\nM2\n"), "nc.number p.ngc:9") << line;
    }
    for (const char* line : {"#1=5", "G1 X#1 F60", "G1 X[1+1] F60", "(a) O5"}) {
        EXPECT_EQ(refusal(sub + kStart + line + "\nM2\n"), "nc.not_understood p.ngc:9") << line;
    }
    EXPECT_EQ(refusal(kStart + "M98 P5\nM2\nO5\n" + x(1) + "M99 P3\n"), "nc.o_word p.ngc:10");
}

// n calls within one another.
std::string chain(int n) {
    std::string text = kStart + "M98 P1\nM2\n";
    for (int i = 1; i <= n; ++i) {
        text += "O" + std::to_string(i) + "\n" + x(1) +
                (i < n ? "M98 P" + std::to_string(i + 1) + "\n" : "") + "M99\n";
    }
    return text;
}

TEST(LinuxCncFlow, CallsGoAsDeepAsTheInterpreterTakesThem) {
    EXPECT_EQ(moves(chain(9)), "111111111");
    EXPECT_EQ(refusal(chain(10)), "nc.nesting p.ngc:42");
    EXPECT_EQ(refusal(chain(100'000)), "nc.nesting p.ngc:42");
    // Known already from a shallow call when the deep one comes to it.
    std::string text = chain(9);
    text.insert(kStart.size(), "M98 P8\n");
    text += "O10 (calls one that is known by then)\nM98 P1\nM99\n";
    EXPECT_EQ(moves(text), "11111111111");
    text.insert(text.find("M2"), "M98 P10\n");
    EXPECT_EQ(refusal(text), "nc.nesting p.ngc:46");
}

TEST(LinuxCncFlow, NothingHangsOrFillsTheMemory) {
    EXPECT_EQ(refusal(kStart + "o1 repeat [999999999999]\no1 endrepeat\nM2\n"),
              "nc.too_many_lines p.ngc:6");
    EXPECT_EQ(refusal(kStart + "o1 repeat [99999999999999999999999]\no1 endrepeat\nM2\n"),
              "nc.too_many_lines p.ngc:6");
    std::string text = kStart;
    for (int i = 1; i <= 9; ++i) {
        text += "o" + std::to_string(i) + " repeat [1000]\n";
    }
    for (int i = 9; i >= 1; --i) {
        text += "o" + std::to_string(i) + " endrepeat\n";
    }
    EXPECT_EQ(refusal(text + "M2\n"), "nc.too_many_lines p.ngc:12");
    text = kStart + "M98 P1 L1000\nM2\n";
    for (int i = 1; i <= 8; ++i) {
        text += "O" + std::to_string(i) + "\nM98 P" + std::to_string(i + 1) + " L1000\nM99\n";
    }
    EXPECT_EQ(refusal(text + "O9\nM99\n"), "nc.too_many_lines p.ngc:24");
    text = kStart;
    for (int i = 1; i <= 100'000; ++i) {
        text += "o" + std::to_string(i) + " repeat [1]\n";
    }
    EXPECT_EQ(refusal(text), "nc.nesting p.ngc:106");
}

TEST(ProgramFlow, EndsWhereItIsTold) {
    const ProgramFlow flow{
        .main = {{.kind = FlowStep::Kind::Repeat,
                  .first = 1,
                  .last = 4,
                  .times = 1000,
                  .body = {{.kind = FlowStep::Kind::Lines, .first = 2, .last = 3}}}}};
    std::vector<int> seen;
    run_flow(flow, "p", [&](std::int32_t line, FlowLine kind) {
        EXPECT_EQ(kind == FlowLine::Code, line == 2 || line == 3);
        seen.push_back(line);
        return seen.size() < 6;
    });
    EXPECT_EQ(seen, (std::vector<int>{1, 2, 3, 4, 1, 2}));
}

}  // namespace
}  // namespace meshwind
