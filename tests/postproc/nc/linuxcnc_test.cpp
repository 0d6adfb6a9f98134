#include "postproc/nc/linuxcnc.h"

#include <cmath>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "postproc/robot/dialects.h"
#include "tests/support/block_lists.h"

namespace meshwind {
namespace {

const std::string kStart = "G21 G90\nG0 A0 B0 C0\nG0 X100 Y0 Z0\nM0\nG91 G93\n";

using test::add;
using test::empty_list;
using test::random_list;
using test::six_axis;

std::string write(const Machine& machine, const BlockList& list) {
    return LinuxCnc().write(machine, list, {.version = "0.1.0", .mandrel = "tee.stl"});
}

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

std::string refusal(const std::string& text) {
    try {
        (void)LinuxCnc().read(test::as_ours(text), "p.ngc", six_axis());
    } catch (const InputError& error) {
        return error.code() + " " + error.place();
    }
    return "accepted";
}

TEST(LinuxCnc, WritesThisProgram) {
    const Machine machine = six_axis();
    BlockList list = empty_list(machine);  // C Z Y X A B
    add(list, {-63666, 141421, 0, 157797, 66078, -1}, 0.0);
    add(list, {-66560, 144957, 0, 157797, 66078, -1}, 0.01);
    add(list, {-69454, 148492, 0, 157797, 66078, 0}, 0.0123456, 1);
    EXPECT_EQ(write(machine, list),
              "(meshwind 0.1.0)\n"
              "(mandrel: tee.stl)\n"
              "(machine: Six-axis winder)\n"
              "(fibre: 0.000 m)\n"
              "(time: 0.2 s)\n"
              "(of these where blocks meet: 0.1 s)\n"
              "(blocks: 2)\n"
              "G21 G90 G94 G17 G40 G49 G80\n"
              "G64 P2 Q0.01\n"
              "(approach: rotary axes turn first, then the linear axes move together;)\n"
              "(bring the eye clear of the mandrel by hand before the start)\n"
              "G90 G0 A66.078 B-0.001 C-63.666\n"
              "G90 G0 X157.797 Y0.000 Z141.421\n"
              "(MSG, tie the fibre on at the landing point, then start again)\n"
              "M0\n"
              "G91 G93\n"
              "(course 0)\n"
              "G1 Z3.536 C-2.894 F6000\n"
              "(course 1)\n"
              "G1 Z3.535 B0.001 C-2.894 F4860.03\n"
              "M2\n");
}

TEST(LinuxCnc, RoundTripIsExact) {
    for (const unsigned seed : {1u, 2u, 3u}) {
        Machine machine = six_axis();
        machine.eye_chain[1].resolution_nano = 500'000;
        machine.mandrel_chain[0].resolution_nano = 15'625'000;  // 1/64 deg
        const LinuxCnc dialect;
        const BlockList planned = dialect.prepare(random_list(machine, seed, 20'000));
        const BlockList read = dialect.read(write(machine, planned), "p.ngc", machine);
        EXPECT_EQ(read.axes, planned.axes);
        ASSERT_EQ(read.nano, planned.nano) << "seed " << seed;
        ASSERT_EQ(read.blocks.size(), planned.blocks.size());
        for (std::size_t i = 1; i < read.blocks.size(); ++i) {
            ASSERT_NEAR(read.blocks[i].duration_s / planned.blocks[i].duration_s, 1.0, 6e-6);
            ASSERT_EQ(read.blocks[i].piece, planned.blocks[i].piece);
            ASSERT_GT(read.blocks[i].line, read.blocks[i - 1].line - 1);
        }
        EXPECT_EQ(write(machine, read).substr(300), write(machine, planned).substr(300));
    }
}

TEST(LinuxCnc, EveryLineIsOneTheInterpreterReads) {
    Machine machine = six_axis();
    machine.name = "winder (left) " + std::string(400, 'x') + "\nM2 \xc3\xa9";
    const std::vector<std::string> lines = lines_of(write(machine, random_list(machine, 7, 5000)));
    EXPECT_EQ(lines.back(), "M2");
    for (const std::string& line : lines) {
        ASSERT_LE(line.size(), kLinuxCncLineLength);
        if (line[0] == '(') {
            ASSERT_EQ(line.find_first_of("()", 1), line.size() - 1) << line;
            continue;
        }
        ASSERT_EQ(line.find_first_of("eE\t\r"), std::string::npos) << line;
        ASSERT_EQ(line.find("-0.000"), std::string::npos) << line;
        if (line.substr(0, 2) == "G1") {
            const std::size_t feed = line.find(" F");
            ASSERT_NE(feed, std::string::npos) << line;
            ASSERT_GT(std::stod(line.substr(feed + 2)), 0.0) << line;
        }
    }
}

TEST(LinuxCnc, NeverGivesTheInterpreterATinyLinearFeedBesideATurn) {
    const Machine machine = six_axis();
    BlockList list = empty_list(machine);
    add(list, {0, 0, 0, 100'000, 0, 0}, 0.0);
    add(list, {360'000, 0, 0, 100'001, 0, 0}, 1.0);     // 0.001 mm beside a whole turn in 1 s
    add(list, {360'001, 15, 0, 100'001, 0, 0}, 10.0);   // one step of C
    add(list, {360'001, 16, 0, 100'001, 0, 0}, 100.0);  // no turn: left alone
    add(list, {0, 16, 0, 100'001, 0, 0}, 100.0);        // turn alone: left alone
    add(list, {-1000, 1016, 0, 100'001, 0, 0}, 1.0);    // fast enough: left alone
    const LinuxCnc dialect;
    const BlockList prepared = dialect.prepare(list);
    EXPECT_EQ(prepared.blocks.size(), 8u);
    EXPECT_NEAR(prepared.duration_s(), list.duration_s(), 1e-12);
    EXPECT_EQ(dialect.prepare(prepared).nano, prepared.nano);
    for (const std::string& line : lines_of(write(machine, list))) {
        if (line.substr(0, 2) != "G1" || line.find_first_of("ABC") == std::string::npos) {
            continue;
        }
        double square = 0.0;
        for (const char letter : {'X', 'Y', 'Z'}) {
            const std::size_t at = line.find(letter);
            square += at == std::string::npos ? 0.0 : std::pow(std::stod(line.substr(at + 1)), 2);
        }
        const double feed = std::stod(line.substr(line.find('F') + 1));
        EXPECT_TRUE(square == 0.0 || std::sqrt(square) * feed >= 0.1) << line;
    }
    // Every planned position is still an end of a block, in order.
    std::size_t at = 0;
    for (std::size_t i = 0; i < list.blocks.size(); ++i) {
        while (at < prepared.blocks.size() &&
               !std::equal(list.row(i).begin(), list.row(i).end(), prepared.row(at).begin())) {
            ++at;
        }
        EXPECT_LT(at, prepared.blocks.size());
    }
}

TEST(LinuxCnc, ControllerLinesMustBeHarmless) {
    for (const char* line :
         {"G1 X1 F1", "M2", "G20", "M3 S100", "G64 P0.01 (open", "O7", "M98 P7", "o7 call"}) {
        Machine machine = six_axis();
        machine.controller.header = {line};
        EXPECT_THROW((void)write(machine, random_list(machine, 1, 3)), InputError) << line;
    }
    Machine machine = six_axis();
    machine.controller.header = {"G91 G64 P0.05 (a mode that the start must not inherit)"};
    const BlockList list = random_list(machine, 1, 3);
    EXPECT_EQ(LinuxCnc().read(write(machine, list), "p.ngc", machine).nano, list.nano);
}

TEST(LinuxCnc, TakesTheCornerToleranceFromTheHeader) {
    Machine machine = six_axis();
    const auto tolerance_mm = [&](std::vector<std::string> header) {
        machine.controller.header = std::move(header);
        return LinuxCnc().corner_tolerance_mm(machine);
    };
    EXPECT_EQ(LinuxCnc().corner_tolerance_mm(machine), 2.0);
    EXPECT_EQ(tolerance_mm({"g64 p.25 q1"}), 0.25);
    EXPECT_EQ(tolerance_mm({"G64 P1", "M8", "(G64 P7) G4 P3", "G64P0.5"}), 0.5);
    for (const char* const line : {"", "G64", "G64 P0", "G61", "G4 P3", "(G64 P1)"}) {
        EXPECT_TRUE(std::isinf(tolerance_mm({line}))) << line;
    }
    EXPECT_TRUE(std::isinf(tolerance_mm({"G64 P1", "G64"})));
}

TEST(LinuxCnc, RefusesLettersFeedAndRestingBlocks) {
    const BlockList list = random_list(six_axis(), 1, 3);
    Machine machine = six_axis();
    machine.controller.feed = FeedMode::PerMinute;
    EXPECT_THROW((void)write(machine, list), InputError);
    BlockList other = list;
    other.axes[0].letter = 'E';
    EXPECT_THROW((void)write(six_axis(), other), InputError);
    other = list;
    other.blocks[2].duration_s = 0.0;
    EXPECT_THROW((void)write(six_axis(), other), InputError);
    EXPECT_THROW((void)make_dialect("heidenhain"), InputError);
    EXPECT_EQ(make_dialect("linuxcnc")->extension(), ".ngc");
}

TEST(LinuxCncRead, TakesWhatTheInterpreterTakes) {
    const Machine machine = six_axis();
    const BlockList list = LinuxCnc().read(
        "%\n(head)\r\nN10 g21 g90 ; words\nG0A0B0C0\nG0 X 100.000000000000 Y-.5 Z+7.\nM1\n"
        "G91 G93\nG1X1.5F60\n(course 4) x-1.25 c-360 f30\nG90 X100 F120\n"
        "G94 G91 G1 Z3 Y4 F300\nC90 F900\nM30\nX9\n",
        "p.ngc", machine);
    ASSERT_EQ(list.blocks.size(), 6u);
    const std::size_t x = *machine.joint_of('X');
    EXPECT_EQ(list.value(0, x), 100.0);
    EXPECT_EQ(list.value(0, *machine.joint_of('Y')), -0.5);
    EXPECT_EQ(list.value(1, x), 101.5);
    EXPECT_EQ(list.value(2, x), 100.25);
    EXPECT_EQ(list.value(2, 0), -360.0);
    EXPECT_EQ(list.blocks[2].piece, 4);
    EXPECT_EQ(list.blocks[2].line, 9);
    EXPECT_DOUBLE_EQ(list.blocks[2].duration_s, 2.0);
    EXPECT_EQ(list.value(3, x), 100.0);
    EXPECT_DOUBLE_EQ(list.blocks[4].duration_s, 1.0);  // 5 mm at 300 mm/min
    EXPECT_DOUBLE_EQ(list.blocks[5].duration_s, 6.0);  // 90 deg at 900 deg/min
}

TEST(LinuxCncRead, NamesTheLineOfWhatItRefuses) {
    EXPECT_EQ(refusal(kStart + "G1 X1 F60\nM2\n"), "accepted");
    EXPECT_EQ(refusal(kStart + "G1 X1\nM2\n"), "nc.feed p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 X1 F0\nM2\n"), "nc.feed p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 X1e3 F60\nM2\n"), "nc.not_understood p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 X1-3 F60\nM2\n"), "nc.number p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 X F60\nM2\n"), "nc.number p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 X99999999999 F60\nM2\n"), "nc.number p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 X0.0000000001 F60\nM2\n"), "nc.number p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 X0.0001 F60\nM2\n"), "nc.resolution p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 X1 X1 F60\nM2\n"), "nc.word_twice p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 E1 F60\nM2\n"), "nc.not_understood p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G2 X1 I1 F60\nM2\n"), "nc.not_understood p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 G0 X1 F60\nM2\n"), "nc.not_understood p.ngc:6");
    EXPECT_EQ(refusal(kStart + "M98 P100 L3\nM2\n"), "nc.no_subprogram p.ngc:6");
    EXPECT_EQ(refusal(kStart + "#1=3\nM2\n"), "nc.not_understood p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 (a (b)) X1 F60\nM2\n"), "nc.comment p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 X1 F60 (" + std::string(300, 'x') + ")\nM2\n"),
              "nc.long_line p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 X1 F60\nG0 Z0\nM2\n"), "nc.rapid p.ngc:7");
    EXPECT_EQ(refusal(kStart + "G1 X1 F60\n"), "nc.no_end p.ngc:6");
    EXPECT_EQ(refusal(kStart + "G1 X1 F60\nG94 G1 X1\nM2\n"), "nc.feed p.ngc:7");
    EXPECT_EQ(refusal(kStart + "M2\n"), "nc.no_motion p.ngc:6");
    EXPECT_EQ(refusal(""), "nc.no_end p.ngc:0");
    EXPECT_EQ(refusal("G21 G90 G93\nG1 X1 F60\nM2\n"), "nc.unknown_start p.ngc:2");
    EXPECT_EQ(refusal("X1\nM2\n"), "nc.no_motion_mode p.ngc:1");
    EXPECT_EQ(refusal("G20\nM2\n"), "nc.not_understood p.ngc:1");
    EXPECT_EQ(refusal("\xef\xbb\xbfG21\nM2\n"), "nc.not_understood p.ngc:1");
}

TEST(LinuxCnc, TieOnIsWrittenAndReadBack) {
    const Machine machine = six_axis();
    const BlockList list = random_list(machine, 1, 3);
    const std::string text =
        LinuxCnc().write(machine, list, {.tie_on_mm = Eigen::Vector3d(12.3449, -6.7891, -0.0001)});
    EXPECT_NE(text.find("(tie on at X12.345 Y-6.789 Z0.000 on the mandrel)\n"), std::string::npos);
    const BlockList read = LinuxCnc().read(text, "p.ngc", machine);
    ASSERT_TRUE(read.tie_on_mm.has_value());
    EXPECT_EQ(*read.tie_on_mm, Eigen::Vector3d(12.345, -6.789, 0.0));
    EXPECT_EQ(read.nano, list.nano);
    EXPECT_FALSE(LinuxCnc().read(write(machine, list), "p.ngc", machine).tie_on_mm.has_value());
}

TEST(LinuxCncRead, TieOnIsReadWholeOrRefused) {
    const std::string moves = kStart + "G1 X1 F60\nM2\n";
    const std::string good = "(tie on at X1.5 Y-2 Z3.000 on the mandrel)\n";
    EXPECT_EQ(refusal(good + moves), "accepted");
    EXPECT_EQ(refusal("(note: tie on here)\n" + moves), "accepted");
    EXPECT_EQ(refusal(good + good + moves), "nc.tie_on p.ngc:2");
    for (const char* bad :
         {"tie on", "tie on at X1.5 Y-2 Z3.000", "tie on at X1.5 Y-2 on the mandrel",
          "tie on at X1.5 Y-2 Z on the mandrel", "tie on at X1.5Y-2 Z3 on the mandrel",
          "tie on at X1.5 Y-2 Z3 on the mandrel ", "tie on at X1e2 Y-2 Z3 on the mandrel",
          "tie on at Xnan Y-2 Z3 on the mandrel", "tie on at X1 Yinf Z3 on the mandrel",
          "tie on at X1.5 Z3 Y-2 on the mandrel", "tie on at X1.5.2 Y-2 Z3 on the mandrel"}) {
        EXPECT_EQ(refusal('(' + std::string(bad) + ")\n" + moves), "nc.tie_on p.ngc:1") << bad;
    }
    Machine machine = six_axis();
    machine.controller.header = {"(tie on at X1 Y2 Z3 on the mandrel)"};
    EXPECT_THROW((void)write(machine, random_list(machine, 1, 3)), InputError);
}

// The head of a program that turns on pins says where they stand.
TEST(LinuxCncRead, PinsAreReadWholeOrRefused) {
    const Machine machine = six_axis();
    PinRing ring{.rim = 2,
                 .count = 36,
                 .diameter_mm = 2.0,
                 .height_mm = 2.25,
                 .strand_mm = 0.690988,
                 .offset_mm = 8.0,
                 .azimuth_rad = rad_from_deg(-12.5)};
    ProgramHeader header;
    header.pins = {ring};
    const std::string text = LinuxCnc().write(machine, random_list(machine, 1, 3), header);
    const std::string line = "pins at rim 2: N36 D2.0000 H2.2500 S0.690988 Z8.000000 A-12.5000000";
    ASSERT_NE(text.find('(' + line + ")\n"), std::string::npos) << text;
    const BlockList read = LinuxCnc().read(text, "p.ngc", machine);
    ASSERT_EQ(read.pins.size(), 1U);
    EXPECT_EQ(read.pins[0].rim, 2);
    EXPECT_EQ(read.pins[0].count, 36);
    EXPECT_EQ(read.pins[0].height_mm, 2.25);
    EXPECT_EQ(read.pins[0].strand_mm, 0.690988);
    EXPECT_EQ(read.pins[0].offset_mm, 8.0);
    EXPECT_NEAR(read.pins[0].azimuth_rad, ring.azimuth_rad, 1e-15);
    const std::string moves = kStart + "G1 X1 F60\nM2\n";
    for (const char* bad :
         {"pins at rim ", "pins at rim 0: N36", "pins at rim 0.5: N36 D2 H2 S1 Z8 A0",
          "pins at rim 0: N0 D2 H2 S1 Z8 A0", "pins at rim 0: N3.5 D2 H2 S1 Z8 A0",
          "pins at rim 0: N36 D0 H2 S1 Z8 A0", "pins at rim 0: N36 D2 H-2 S1 Z8 A0",
          "pins at rim 0: N36 D2 H2 S1 Z8 Anan", "pins at rim -1: N36 D2 H2 S1 Z8 A0",
          "pins at rim 0: N1e9 D2 H2 S1 Z8 A0", "pins at rim 0: N99999999999 D2 H2 S1 Z8 A0",
          "pins at rim 0: N36 D2 H2 S1 Z8 A0 "}) {
        EXPECT_EQ(refusal('(' + std::string(bad) + ")\n" + moves), "nc.pins p.ngc:1") << bad;
    }
    const std::string good = "(pins at rim 0: N36 D2 H2 S1 Z8 A-90)\n";
    EXPECT_EQ(refusal(good + moves), "accepted");
    EXPECT_EQ(refusal(good + good + moves), "nc.pins p.ngc:2");
}

TEST(LinuxCncRead, SurvivesEveryTruncationAndByteChange) {
    const Machine machine = six_axis();
    const std::string text = write(machine, random_list(machine, 5, 10));
    std::mt19937 engine(5);
    for (std::size_t i = 0; i < text.size(); ++i) {
        for (std::string changed : {text.substr(0, i), text}) {
            if (changed.size() == text.size()) {
                changed[i] = static_cast<char>(engine() % 256);
            }
            try {
                (void)LinuxCnc().read(changed, "p.ngc", machine);
            } catch (const InputError&) {
                continue;
            }
        }
    }
}

}  // namespace
}  // namespace meshwind
