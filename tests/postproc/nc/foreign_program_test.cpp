// Programs that are not by meshwind: what is taken as meant, and told.
#include <cmath>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "postproc/robot/dialects.h"
#include "tests/support/block_lists.h"
#include "tests/support/dialect_lists.h"

namespace meshwind {
namespace {

using test::machine_for;

BlockList read(const std::string& dialect, const std::string& text) {
    return make_dialect(dialect)->read(text, "p", machine_for(dialect));
}

std::string refusal(const std::string& dialect, const std::string& text) {
    try {
        (void)read(dialect, text);
    } catch (const InputError& error) {
        return error.code() + " " + error.place();
    }
    return "accepted";
}

double at(const BlockList& list, std::size_t block, char axis) {
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        if (list.axes[a].letter == axis) {
            return list.value(block, a);
        }
    }
    return NAN;
}

bool tells(const BlockList& list, const std::string& words) {
    for (const std::string& remark : list.head->remarks) {
        if (remark.find(words) != std::string::npos) {
            return true;
        }
    }
    return false;
}

TEST(ForeignProgram, AxesThatAreNeverPlacedStandAtZero) {
    const BlockList list = read("linuxcnc", "G91 G94\nG1 X10 C90 F600\nM2\n");
    ASSERT_EQ(list.blocks.size(), 2u);
    EXPECT_EQ(at(list, 0, 'X'), 0.0);
    EXPECT_EQ(at(list, 1, 'C'), 90.0);
    EXPECT_EQ(list.head->remarks.size(), list.axes.size());
    EXPECT_TRUE(tells(list, "axis X has no absolute position"));
    EXPECT_EQ(refusal("linuxcnc", test::as_ours("G91 G94\nG1 X10 C90 F600\nM2\n")),
              "nc.unknown_start p:2");
}

// As the controller does: the place is rounded, not each step to it.
TEST(ForeignProgram, FineDigitsAreRoundedWithoutDrift) {
    std::ostringstream text;
    text << "G90 G0 X0 Y0 Z0 A0 B0 C0\nG91 G94 F600\n";
    for (int i = 0; i < 3000; ++i) {
        text << "G1 X0.0013333333333333 C-0.00033333\n";
    }
    text << "M2\n";
    const BlockList list = read("linuxcnc", text.str());
    ASSERT_EQ(list.blocks.size(), 3001u);
    EXPECT_NEAR(at(list, 3000, 'X'), 4.0, 0.0005);
    EXPECT_NEAR(at(list, 3000, 'C'), -1.0, 0.0005);
    EXPECT_EQ(list.head->remarks.size(), 2u);
    EXPECT_TRUE(tells(list, "axis C has"));
}

TEST(ForeignProgram, RapidMovesWithTheFibreOnRunAsFastAsTheAxes) {
    const Machine machine = machine_for("linuxcnc");
    const std::size_t x = *machine.joint_of('X');
    const std::size_t c = *machine.joint_of('C');
    const BlockList list =
        read("linuxcnc", "G90 G0 X0 Y0 Z0 A0 B0 C0\nG1 X1 F600\nG0 X101\nG0 C3600 X102\nM2\n");
    ASSERT_EQ(list.blocks.size(), 4u);
    EXPECT_DOUBLE_EQ(list.blocks[2].duration_s, 100.0 / machine.axis(x).velocity);
    EXPECT_DOUBLE_EQ(list.blocks[3].duration_s, rad_from_deg(3600.0) / machine.axis(c).velocity);
    EXPECT_TRUE(tells(list, "2 rapid moves with the fibre on"));
}

// Marlin runs G0 at F; programs for it have nothing else.
TEST(ForeignProgram, ProgramsOfRapidMovesWind) {
    const std::string head = "; Parameters " + std::string(200, 'x') + "\nG21\nG90\nG0 F600\n";
    const std::string moves = "G0 X5 C20\nG0 X65 C380\nG92 C0\nG0 X5 C90\n";
    const BlockList list = read("marlin", head + "G0 X0 Y0 Z0 A0 B0 C0\n" + moves);
    ASSERT_EQ(list.blocks.size(), 4u);  // the start, and the moves behind it
    EXPECT_EQ(at(list, 0, 'C'), 0.0);
    EXPECT_EQ(at(list, 3, 'C'), 470.0);
    EXPECT_DOUBLE_EQ(list.blocks[2].duration_s, 6.0);
    EXPECT_DOUBLE_EQ(list.blocks[3].duration_s, 6.0);
    EXPECT_TRUE(tells(list, "no G1 is in the program"));
    EXPECT_TRUE(tells(list, "G92 says once"));
    EXPECT_TRUE(tells(list, "taken to end with the file"));
    // With a stop the fibre is on behind it.
    const BlockList stopped = read("marlin", head + "G0 X0 C0\nG0 Y3 C7\nM0\n" + moves);
    ASSERT_EQ(stopped.blocks.size(), 4u);
    EXPECT_EQ(at(stopped, 0, 'C'), 7.0);
    EXPECT_EQ(stopped.head->approach.size(), 2u);
}

TEST(ForeignProgram, InchesAreTurnedIntoMillimetres) {
    const BlockList list =
        read("linuxcnc", "G20 G90 G94\nG0 X1 Y0 Z0 A0 B0 C0\nG1 X3 C10 F60\nM2\n");
    EXPECT_DOUBLE_EQ(at(list, 0, 'X'), 25.4);
    EXPECT_DOUBLE_EQ(at(list, 1, 'X'), 76.2);
    EXPECT_DOUBLE_EQ(at(list, 1, 'C'), 10.0);
    EXPECT_NEAR(list.blocks[1].duration_s, 2.0, 1e-12);
}

TEST(ForeignProgram, WordsThatMoveNoAxisAreToldAndLeftOut) {
    const BlockList list = read("linuxcnc",
                                "G90 G0 X0 Y0 Z0 A0 B0 C0 T1\nM3 S200\nG4 P2\nG1 X1 F600 M8\n"
                                "G54 G1 X2\nM2\n");
    ASSERT_EQ(list.blocks.size(), 3u);
    EXPECT_TRUE(tells(list, "G4 (1), M3 (1), M8 (1), P (1), S (1), T (1)"));
    EXPECT_EQ(list.head->remarks.size(), 1u);
}

// What would be read as another motion than the controller's.
TEST(ForeignProgram, RefusesWhatMovesInAWayThatIsNotSeen) {
    const std::string start = "G90 G94\nG1 X1 F600\n";
    for (const char* line : {"G2 X1 Y1 I1 J0", "G28", "G53 X3", "G43 H1", "G95 F1", "#1=2",
                             "G1 X[1+1]", "M98 P7", "G81 X1 Z1 R2", "G1 X1e3"}) {
        EXPECT_NE(refusal("linuxcnc", start + line + "\nM2\n"), "accepted") << line;
    }
    EXPECT_EQ(refusal("grbl", "G1 X1 F600\nM98 P7\n"), "nc.not_understood p:2");
    EXPECT_EQ(refusal("fanuc", "G91 G1 X10 F600.\nM30\n"), "nc.number p:1");  // thousandths?
    EXPECT_EQ(refusal("linuxcnc", ""), "nc.no_end p:0");
    EXPECT_EQ(refusal("linuxcnc", "words without a number\n"), "nc.number p:1");
}

// The same blocks written as others do are read as the same.
TEST(ForeignProgram, SaysWhatOursSays) {
    const Machine machine = machine_for("grbl");
    const BlockList list = test::random_list(machine, 3, 500);
    std::ostringstream text;
    text.precision(7);
    std::vector<double> zero(list.axes.size(), 0.0);
    for (std::size_t i = 0; i < list.blocks.size(); ++i) {
        if (i == 0) {
            text << "G90 G94 G0";
        } else {
            text << "G93 G1 F" << 60.0 / list.blocks[i].duration_s;
        }
        for (std::size_t a = 0; a < list.axes.size(); ++a) {
            text << ' ' << list.axes[a].letter << list.value(i, a) - zero[a];
        }
        text << '\n';
        if (i % 7 == 6) {
            text << "G92 " << list.axes[0].letter << "0\n";
            zero[0] = list.value(i, 0);
        }
    }
    const BlockList again = read("grbl", text.str());
    ASSERT_EQ(again.nano, list.nano);
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        EXPECT_NEAR(again.blocks[i].duration_s, list.blocks[i].duration_s,
                    1e-5 * list.blocks[i].duration_s);
    }
}

}  // namespace
}  // namespace meshwind
