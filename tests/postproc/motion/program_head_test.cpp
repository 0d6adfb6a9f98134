// What a program says before and beside its blocks, in every language.
#include "postproc/motion/program_head.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "postproc/robot/dialects.h"
#include "tests/support/block_lists.h"
#include "tests/support/dialect_lists.h"

namespace meshwind {
namespace {

const std::vector<std::string> kAll = {"linuxcnc", "fanuc", "siemens", "grbl", "marlin", "pulses"};

ProgramHeader header() {
    return {.version = "test",
            .mandrel = "pipe.stl",
            .job_digest = "sha256 8899aabbccddeeff",
            .code_digest = "sha256/128 00112233445566778899aabbccddeeff",
            .tie_on_mm = Eigen::Vector3d(70.0, 0.0, -1.5)};
}

Machine machine_with(const std::string& dialect, const std::vector<std::string>& lines) {
    Machine machine = test::machine_for(dialect);
    machine.controller.header = lines;
    return machine;
}

std::string text_of(const std::string& dialect, const Machine& machine) {
    return make_dialect(dialect)->write(machine, test::small_program(machine), header());
}

BlockList read(const std::string& dialect, const std::string& text) {
    return make_dialect(dialect)->read(text, "p", test::machine_for(dialect));
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

std::string refusal(const std::string& dialect, const std::string& text) {
    try {
        (void)read(dialect, test::as_ours(text));
    } catch (const InputError& error) {
        return error.code() + " " + error.place() + " " + error.what();
    }
    return "accepted";
}

TEST(ProgramHead, IsReadFromWhatIsWritten) {
    for (const std::string& name : kAll) {
        SCOPED_TRACE(name);
        const BlockList list = read(name, text_of(name, test::machine_for(name)));
        ASSERT_TRUE(list.head.has_value());
        EXPECT_TRUE(list.head->by_meshwind);
        EXPECT_EQ(list.head->job_digest, header().job_digest);
        EXPECT_EQ(list.head->code_digest, header().code_digest);
        EXPECT_TRUE(list.head->path_modes.empty());
        EXPECT_EQ(list.head->has_approach, name != "pulses");
        if (name != "pulses") {
            // Rotary axes first, then the linear ones, then the stop.
            ASSERT_EQ(list.head->approach.size(), 2U);
            const std::vector<bool>& known = list.head->approach.back().known;
            EXPECT_EQ(std::count(known.begin(), known.end(), false), 0);
            EXPECT_EQ(list.head->approach.back().nano,
                      std::vector<std::int64_t>(list.row(0).begin(), list.row(0).end()));
            EXPECT_GT(list.head->stop_line, list.head->approach.back().line);
        }
    }
}

TEST(ProgramHead, TheStopIsBetweenRapidMovesAndWinding) {
    const std::string text = text_of("linuxcnc", test::machine_for("linuxcnc"));
    const auto stop = [](const std::string& t) { return read("linuxcnc", t).head->stop_line; };
    EXPECT_GT(stop(text), 0);
    EXPECT_EQ(stop(replaced(text, "M0\n", "")), 0);
    EXPECT_EQ(stop(replaced(text, "M0\n", "M1\n")), 0);
    EXPECT_EQ(stop(replaced(text, "M0\n", "M0\nG0 X151\nG0 X150\n")), 0);
    const std::size_t first = text.find("G1 ");
    const std::size_t end = text.find('\n', first);
    std::string behind = replaced(text, "M0\n", "");
    behind.insert(behind.find('\n', behind.find("G1 ")) + 1, "M0\n");
    EXPECT_EQ(stop(behind), 0);
    EXPECT_EQ(stop(replaced(replaced(text, "M0\n", ""), text.substr(first, end - first),
                            text.substr(first, end - first) + " M0")),
              0);
}

TEST(ProgramHead, PathModesAreThoseOfTheMachinesLines) {
    const struct {
        const char* dialect;
        const char* line;
        const char* words;
        double corner_mm;
    } cases[] = {{"linuxcnc", "G64 P2 Q0.01", "G64 P2 Q0.01", 2.0},
                 {"linuxcnc", "G64 Q.0100 P02.", "G64 P2 Q0.01", 2.0},
                 {"linuxcnc", "G61", "G61", HUGE_VAL},
                 {"linuxcnc", "G61.1", "G61.1", HUGE_VAL},
                 {"linuxcnc", "G64", "G64", HUGE_VAL},
                 {"fanuc", "G64", "G64", HUGE_VAL},
                 {"siemens", "G642", "G642", HUGE_VAL},
                 {"grbl", "G61", "G61", HUGE_VAL}};
    for (const auto& c : cases) {
        SCOPED_TRACE(std::string(c.dialect) + " " + c.line);
        const Machine machine = machine_with(c.dialect, {c.line});
        const PathMode mode = make_dialect(c.dialect)->path_mode(machine);
        EXPECT_EQ(mode.words, c.words);
        EXPECT_EQ(mode.corner_mm, c.corner_mm);
        const BlockList list = read(c.dialect, text_of(c.dialect, machine));
        ASSERT_EQ(list.head->path_modes.size(), 1U);
        EXPECT_EQ(list.head->path_modes.front().mode.words, c.words);
        EXPECT_EQ(list.head->path_modes.front().block, 1U);
    }
    for (const std::string name : {"marlin", "pulses"}) {
        EXPECT_EQ(make_dialect(name)->path_mode(test::machine_for(name)).words, "");
    }
}

TEST(ProgramHead, ChangesOfThePathModeAreFollowed) {
    std::string text = text_of("linuxcnc", machine_with("linuxcnc", {"G64 P2"}));
    std::size_t third = text.find("G1 ");
    third = text.find("G1 ", third + 1);
    text.insert(text.find("G1 ", third + 1), "G61\nG64 P2\nG64 P0.5\n");
    const std::vector<PathModeFrom> modes = read("linuxcnc", text).head->path_modes;
    ASSERT_EQ(modes.size(), 2U);
    EXPECT_EQ(modes.back().mode.corner_mm, 0.5);
    EXPECT_EQ(modes.back().block, 3U);
    EXPECT_EQ(modes.front().block, 1U);
}

TEST(ProgramHead, CodeIsTheSameWhateverTheTextLooksLike) {
    for (const std::string& name : kAll) {
        SCOPED_TRACE(name);
        const auto dialect = make_dialect(name);
        const std::string text = text_of(name, test::machine_for(name));
        const std::string code = dialect->code_of(text, "p");
        std::string looks;
        for (const std::string& line : test::split_lines(text)) {
            looks += line + "  \r\n\r\n";
        }
        EXPECT_TRUE(dialect->code_of(looks, "p") == code);
        const std::string comment = name == "linuxcnc" || name == "fanuc" ? "(by hand)\n" : "; x\n";
        EXPECT_TRUE(dialect->code_of(comment + text, "p") == code);
        if (name != "pulses") {
            EXPECT_EQ(dialect->code_of(replaced(text, "G1 ", "N17 G1  "), "p"), code);
            EXPECT_NE(dialect->code_of(replaced(text, "M0\n", ""), "p"), code);
        }
        EXPECT_NE(dialect->code_of(replaced(text, "tie on at X70.000", "tie on at X70.001"), "p"),
                  code);
        EXPECT_NE(dialect->code_of(replaced(text, name == "pulses" ? "block " : "G1 Z7",
                                            name == "pulses" ? "block 1" : "G1 Z8"),
                                   "p"),
                  code);
    }
    // Blanks stand between the numbers of ticks.
    const auto pulses = make_dialect("pulses");
    EXPECT_NE(pulses->code_of("1 23\n", "p"), pulses->code_of("12 3\n", "p"));
    EXPECT_EQ(pulses->code_of("1  23 \n", "p"), pulses->code_of("1 23\n", "p"));
}

// What moves nothing is not written, and what takes no time is not read as a block.
TEST(ProgramHead, RestsAreNoBlocks) {
    for (const std::string name : {"grbl", "marlin"}) {
        const std::string text = text_of(name, test::machine_for(name));
        if (test::machine_for(name).controller.feed == FeedMode::PerMinute) {
            EXPECT_EQ(read(name, replaced(text, "G1 ", "G1 X0 F10\nG1 ")).nano,
                      read(name, text).nano);
        }
    }
    // F alone sets the feed and moves nothing.
    const std::string text = text_of("linuxcnc", test::machine_for("linuxcnc"));
    EXPECT_EQ(read("linuxcnc", replaced(text, "G1 ", "G1 F20\nG1 ")).nano,
              read("linuxcnc", text).nano);
}

TEST(ProgramHead, BlocksThatHaveLostTheirPointAreRefused) {
    const std::string head = "G21\nG90 G0 X0 Y0 Z0 A0 B0 C0\nG91 G93\n";
    EXPECT_EQ(refusal("linuxcnc", head + "G1 C7200000 F1\nM2\n"), "accepted");
    for (const std::string words : {"C100000000", "C4000000000", "Z1000000", "X-100000.001"}) {
        SCOPED_TRACE(words);
        const std::string said = refusal("linuxcnc", head + "G1 " + words + " F1\nM2\n");
        EXPECT_EQ(said.substr(0, 15), "nc.too_far p:4 ");
    }
    EXPECT_EQ(refusal("linuxcnc", "G90 G0 X0 Y0 Z0 A0 B0 C0\nG0 X2e5\n").substr(0, 4), "nc.n");
    EXPECT_EQ(refusal("linuxcnc", "G90 G0 X0 Y0 Z0 A0 B0 C0\nG0 X200000\n").substr(0, 14),
              "nc.too_far p:2");
    // Where an axis comes from is unknown: it may stand there.
    EXPECT_EQ(refusal("linuxcnc", "G90 G0 X0 Y0 Z0 A0 B0 C99999999\nG91 G93\nG1 C1 F1\nM2\n"),
              "accepted");
}

TEST(ProgramHead, AnAxisThatTheMachineLacksIsNamed) {
    const std::string said = refusal("grbl", "G90 G0 X0 Y0 Z0 A0 B0 C0\nG91 G1 V27.017 F100\nM2\n");
    EXPECT_EQ(said.substr(0, 21), "nc.not_understood p:2") << said;  // not of GRBL
    const std::string missing =
        refusal("linuxcnc", "G90 G0 X0 Y0 Z0 A0 B0 C0\nG91 G93 G1 V27.017 F100\nM2\n");
    EXPECT_EQ(missing.substr(0, 14), "nc.no_axis p:2") << missing;
    EXPECT_NE(missing.find("\"V27.017\""), std::string::npos) << missing;
    EXPECT_NE(missing.find("Six-axis winder"), std::string::npos) << missing;
}

// Marlin's queue.cpp stores nothing behind ; so it does not count.
TEST(ProgramHead, MarlinDropsCommentsBeforeItCounts) {
    const std::string text = text_of("marlin", test::machine_for("marlin"));
    const std::string comment = "; " + std::string(114, 'x') + "\n";
    EXPECT_EQ(refusal("marlin", comment + text), "accepted");
    EXPECT_EQ(refusal("marlin", "G1" + std::string(90, ' ') + " F100 ; " + std::string(100, 'x') +
                                    "\n" + text)
                  .substr(0, 15),
              "nc.long_line p:");
}

// A line that is nothing but a value is refused before anything is planned.
TEST(ProgramHead, BareValuesInOwnLinesAreRefusedAtOnce) {
    const Machine machine = machine_with("linuxcnc", {"{mandrel}"});
    try {
        make_dialect("linuxcnc")->check(machine);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), "dialect.header_line");
    }
}

}  // namespace
}  // namespace meshwind
