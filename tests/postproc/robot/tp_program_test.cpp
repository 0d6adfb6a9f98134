// TP programs: what is written for FANUC's controllers, and what is refused when it is read.
#include "postproc/robot/tp_program.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "machines/machine_json.h"
#include "postproc/nc/made_from.h"
#include "postproc/nc/nc_reader.h"
#include "tests/support/block_lists.h"
#include "tests/support/dialect_lists.h"

namespace meshwind {
namespace {

using test::add;
using test::empty_list;
using test::machine_for;

// Lines 1 to 7, the instructions from line 4 on; what is given for line 8.
const std::string kStart =
    "/PROG  M\nDEFAULT_GROUP\t= 1,*,*,*,*;\n/MN\n   1:  UFRAME_NUM=0 ;\n   2:  UTOOL_NUM=1 ;\n"
    "   3:J P[1] 10% FINE    ;\n   4:J P[2] 500msec CNT100    ;\n";
const std::string kFrame = "   GP1:\n\tUF : 0, UT : 1,\t\n\t";

// A position of four lines and the axes'.
std::string position(int number, const std::string& x) {
    return "P[" + std::to_string(number) + "]{\n" + kFrame +
           "J1= 0.000 deg,\tJ2= 0.000 deg,\tJ3= 0.000 deg,\n"
           "\tJ4= 0.000 deg,\tJ5= 0.000 deg,\tJ6= 0.000 deg,\n\tE1= " +
           x + " deg\n};\n";
}

const std::string kPositions = "/POS\n" + position(1, "0.000") + position(2, "1.500");

std::string refusal(const std::string& text) {
    try {
        (void)Tp().read(text, "p", machine_for("tp"));
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.code() + " " + error.place();
    }
    return "accepted";
}

// With these instructions from line 8 on, and another position behind the two.
std::string refused_lines(const std::string& lines) {
    return refusal(kStart + lines + kPositions + position(3, "3.000") + "/END\n");
}

// With this in place of the third position, whose lines begin in line 24.
std::string refused_position(const std::string& third) {
    return refusal(kStart + "   5:J P[3] .5sec FINE ;\n" + kPositions + third + "/END\n");
}

TEST(Tp, WritesThisProgram) {
    const Machine machine = machine_for("tp");
    BlockList list = empty_list(machine);
    add(list, {-5015, 3113, -29088, 0, 0, 0, 43004}, 0.0);
    add(list, {-26711, 2391, -29119, 1, 0, 0, 43495}, 0.0865582, 0);
    add(list, {-26711, 2391, -29119, 1, 0, -1, 43495}, 40.01, 1);
    const std::string text = Tp().write(machine, list, {.version = "test"});
    EXPECT_EQ(text.substr(0, 18), "/PROG  WINDING\n/AT");
    EXPECT_NE(text.find("\nLINE_COUNT\t= 23;\n"), std::string::npos);
    EXPECT_EQ(text.substr(text.find("DEFAULT_GROUP")),
              "DEFAULT_GROUP\t= 1,*,*,*,*;\nCONTROL_CODE\t= 00000000 00000000;\n/MN\n"
              "   1:  !meshwind test ;\n   2:  !machine: Robot in front of a spi ;\n"
              "   3:  !+ndle ;\n   4:  !fibre: 0.000 m ;\n   5:  !time: 40.2 s ;\n"
              "   6:  !blocks: 2 ;\n   7:  !axes 1 to 6: A B C U V W, extern ;\n"
              "   8:  !+al: X is E1 ;\n   9:  !J3 is C + B ;\n  10:  UFRAME_NUM=0 ;\n"
              "  11:  UTOOL_NUM=1 ;\n  12:  !approach: all axes move together ;\n  13:  !+, ;\n"
              "  14:  !bring the eye clear of the mandr ;\n  15:  !+el by hand before the start ;\n"
              "  16:J P[1] 10% FINE    ;\n  17:  !tie the fibre on at the landing ;\n"
              "  18:  !+ point, then start again ;\n  19:  PAUSE ;\n  20:  !course 0 ;\n"
              "  21:J P[2] 87msec CNT100    ;\n  22:  !course 1 ;\n"
              "  23:J P[3] 40.1sec FINE    ;\n/POS\n"
              "P[1]{\n   GP1:\n\tUF : 0, UT : 1,\t\n"
              "\tJ1=     3.113 deg,\tJ2=   -29.088 deg,\tJ3=   -29.088 deg,\n"
              "\tJ4=     0.000 deg,\tJ5=     0.000 deg,\tJ6=    43.004 deg,\n"
              "\tE1=    -5.015 deg\n};\n"
              "P[2]{\n   GP1:\n\tUF : 0, UT : 1,\t\n"
              "\tJ1=     2.391 deg,\tJ2=   -29.119 deg,\tJ3=   -29.118 deg,\n"
              "\tJ4=     0.000 deg,\tJ5=     0.000 deg,\tJ6=    43.495 deg,\n"
              "\tE1=   -26.711 deg\n};\n"
              "P[3]{\n   GP1:\n\tUF : 0, UT : 1,\t\n"
              "\tJ1=     2.391 deg,\tJ2=   -29.119 deg,\tJ3=   -29.118 deg,\n"
              "\tJ4=     0.000 deg,\tJ5=     -.001 deg,\tJ6=    43.495 deg,\n"
              "\tE1=   -26.711 deg\n};\n/END\n");
    const BlockList read = Tp().read(text, "p", machine);
    EXPECT_EQ(read.nano, list.nano);
    EXPECT_DOUBLE_EQ(read.blocks[1].duration_s, 0.087);
    EXPECT_DOUBLE_EQ(read.blocks[2].duration_s, 40.1);
    EXPECT_EQ(read.head->approach.size(), 1U);
    EXPECT_EQ(read.head->stop_line, read.head->approach.front().line + 3);
}

// Times become whole milliseconds or tenths of a second, never shorter, and then stay.
TEST(Tp, TimesAreThoseThatCanBeSaid) {
    const Machine machine = machine_for("tp");
    for (const auto& [planned_s, said_s, word] : {std::tuple{1e-6, 0.001, " 1msec "},
                                                  {0.0100001, 0.011, " 11msec "},
                                                  {0.087, 0.087, " 87msec "},
                                                  {32.0, 32.0, " 32000msec "},
                                                  {31.9999, 32.0, " 32000msec "},
                                                  {32.0001, 32.1, " 32.1sec "},
                                                  {3199.99, 3200.0, " 3200.0sec "}}) {
        SCOPED_TRACE(planned_s);
        BlockList list = empty_list(machine);
        add(list, {0, 0, 0, 0, 0, 0, 0}, 0.0);
        add(list, {1, 0, 0, 0, 0, 0, 0}, planned_s, 0);
        const BlockList prepared = Tp().prepare(list);
        EXPECT_DOUBLE_EQ(prepared.blocks[1].duration_s, said_s);
        EXPECT_EQ(Tp().prepare(prepared).blocks[1].duration_s, prepared.blocks[1].duration_s);
        EXPECT_NE(Tp().write(machine, list, {}).find(word), std::string::npos);
    }
    BlockList slow = empty_list(machine);
    add(slow, {0, 0, 0, 0, 0, 0, 0}, 0.0);
    add(slow, {1, 0, 0, 0, 0, 0, 0}, 3200.01, 0);
    EXPECT_THROW((void)Tp().write(machine, slow, {}), InputError);
}

// Whatever a remark says, it has 32 characters, comes back whole, and none ends with a blank.
TEST(Tp, RemarksAreParted) {
    const Machine machine = machine_for("tp");
    for (const std::size_t size : {1U, 31U, 32U, 33U, 63U, 64U, 95U, 110U}) {
        for (const std::string& filling :
             {std::string("a b"), std::string("x  y   z"), std::string("a;b!c")}) {
            ProgramHeader header{.version = "test", .mandrel = "a"};
            while (header.mandrel.size() < size) {
                header.mandrel += filling;
            }
            header.mandrel += '.';
            const std::string text = Tp().write(machine, test::small_program(machine), header);
            for (const std::string& line : test::split_lines(text)) {
                const std::size_t opens = line.find('!');
                if (opens != std::string::npos) {
                    EXPECT_LE(line.size() - opens, 1U + 32U + 2U) << line;
                    EXPECT_NE(line[line.size() - 3], ' ') << line;
                }
            }
            std::string plain = header.mandrel;
            std::replace(plain.begin(), plain.end(), ';', ',');
            EXPECT_EQ(made_from(text)->mandrel, plain.substr(0, 109)) << plain;
        }
    }
}

// A remark of one's own that begins as if it went on from another.
TEST(Tp, ARemarkStaysApart) {
    Machine machine = machine_for("tp");
    machine.controller.header = {"! +words"};
    const std::string text = Tp().write(machine, test::small_program(machine), {});
    EXPECT_NE(tp_text(tp_lines(text)).find("\n! +words\n"), std::string::npos);
}

// External axes 4 to 6 are of the positioner; a program says which groups it moves.
TEST(Tp, APositionerIsTheSecondGroup) {
    Machine machine = machine_for("tp");
    machine.controller.external_axes = "---X";
    const BlockList list = test::small_program(machine);
    const std::string text = Tp().write(machine, list, {.version = "test"});
    EXPECT_NE(text.find("\nDEFAULT_GROUP\t= 1,1,*,*,*;\n"), std::string::npos);
    EXPECT_NE(text.find(" deg\n   GP2:\n\tUF : 0, UT : 1,\t\n\tJ1=   -70.529 deg\n};\n"),
              std::string::npos);
    EXPECT_EQ(text.find("E1="), std::string::npos);
    EXPECT_EQ(Tp().read(text, "p", machine).nano, list.nano);
    EXPECT_EQ(refusal(text), "nc.no_axis p:17");  // the machine with its spindle as E1
    machine.controller.external_axes = "X";
    const Machine track = read_machine(MESHWIND_SOURCE_DIR "/machines/robot_track.json");
    const std::string both = Tp().write(track, test::small_program(track), {});
    EXPECT_NE(both.find("\tE1=   -70.529 deg,\tE2=    81.421  mm\n"), std::string::npos);
}

// J3 is the forearm's angle to the ground, whichever way the axes turn.
TEST(Tp, TheThirdAxisIsCountedFromTheGround) {
    Machine machine = machine_for("tp");
    BlockList list = empty_list(machine);
    add(list, {0, 0, 10'000, 50'000, 0, 0, 0}, 0.0);
    add(list, {1, 0, -12'345, 50'000, 0, 0, 0}, 1.0, 0);
    const auto third = [&] {
        const std::string text = Tp().write(machine, list, {});
        EXPECT_EQ(Tp().read(text, "p", machine).nano, list.nano);
        const std::size_t at = text.rfind("J3=");
        return std::strtod(text.c_str() + at + 3, nullptr);
    };
    EXPECT_EQ(third(), 50.0 - 12.345);
    machine.eye_chain[2].direction *= -1.0;
    EXPECT_EQ(third(), 50.0 + 12.345);
    machine.eye_chain[2].direction = Eigen::Vector3d::UnitX();
    EXPECT_EQ(third(), 50.0);
}

TEST(Tp, AProgramOfTooManyLinesIsRefused) {
    const Machine machine = machine_for("tp");
    BlockList list = empty_list(machine);
    for (int i = 0; i <= 32'001; ++i) {
        add(list, {i, 0, 0, 0, 0, 0, 0}, i == 0 ? 0.0 : 0.04, 0);
    }
    try {
        (void)Tp().write(machine, list, {});
        ADD_FAILURE() << "written";
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), "dialect.too_many_lines");
    }
}

TEST(Tp, OwnLines) {
    const auto refused = [](const std::string& line) {
        Machine machine = machine_for("tp");
        machine.controller.header = {line};
        machine.controller.footer = {line};
        try {
            Tp().check(machine);
        } catch (const InputError& error) {
            EXPECT_EQ(error.code(), "dialect.header_line");
            return true;
        }
        return false;
    };
    for (const char* line :
         {"", "! {mandrel}", "!words", "DO[3]=ON", "do[3] = OFF", "PAYLOAD[2]", "MESSAGE[ready]"}) {
        EXPECT_FALSE(refused(line)) << line;
    }
    for (const char* line : {"J P[1] 5% FINE", "WAIT 1.00(sec)", "END", "PAUSE", "UTOOL_NUM=2",
                             "CALL HOME", "! tie on", "DO[3]=ON ;", "! a ; b", "/POS"}) {
        EXPECT_TRUE(refused(line)) << line;
    }
}

TEST(TpRead, NamesTheLineOfWhatItRefuses) {
    const std::string good = "   5:J P[3] .5sec FINE ;\n";
    ASSERT_EQ(refused_lines(good), "accepted");
    const struct {
        std::string lines;
        const char* said;
    } cases[] = {
        {"    :  !course 5 ;\n\n    :   ;\n 5: j P[3:\"name\"] 500 msec cnt 1 ;\n", "accepted"},
        {"5:J P[3] 500msec FINE;\r\n", "accepted"},
        {"5:  DO[1]=ON ;\n" + good, "accepted"},
        {"5:J P[2] .5sec FINE ;\n", "nc.feed p:8"},
        {"5:J P[4] .5sec FINE ;\n", "nc.no_position p:8"},
        {"5:J P[] .5sec FINE ;\n", "nc.no_position p:8"},
        {"5:J P[99999999999] .5sec FINE ;\n", "nc.no_position p:8"},
        {"5:J P[3] 10% FINE ;\n", "nc.rapid p:8"},
        {"5:J P[3] 0msec FINE ;\n", "nc.feed p:8"},
        {"5:J P[3] 1.5msec FINE ;\n", "nc.feed p:8"},
        {"5:J P[3] 32001msec FINE ;\n", "nc.feed p:8"},
        {"5:J P[3] .05sec FINE ;\n", "nc.feed p:8"},
        {"5:J P[3] .25sec FINE ;\n", "nc.feed p:8"},
        {"5:J P[3] 3200.1sec FINE ;\n", "nc.feed p:8"},
        {"5:J P[3] 1.2.3sec FINE ;\n", "nc.number p:8"},
        {"5:J P[3] R[1]msec FINE ;\n", "nc.not_understood p:8"},
        {"5:J P[3] 5mm/sec FINE ;\n", "nc.not_understood p:8"},
        {"5:J P[3] 500msec CNT101 ;\n", "nc.not_understood p:8"},
        {"5:J P[3] 500msec CNT ;\n", "nc.not_understood p:8"},
        {"5:J P[3] 500msec CNT100 ACC50 ;\n", "nc.not_understood p:8"},
        {"5:J P[3] 500msec FINE Offset,PR[1] ;\n", "nc.not_understood p:8"},
        {"5:J PR[3] 500msec FINE ;\n", "nc.not_understood p:8"},
        {"5:L P[3] 500msec FINE ;\n", "nc.not_understood p:8"},
        {"5:J P[3] 500msec CNT0 ;\n6:J P[2] 500msec FINE ;\n", "nc.stop_point p:8"},
        {"5:J P[3] 500msec FINE\n", "nc.not_understood p:8"},
        {"J P[3] 500msec FINE ;\n", "nc.not_understood p:8"},
        {"5:  WAIT 1.00(sec) ;\n" + good, "nc.not_understood p:8"},
        {"5:  UTOOL_NUM=2 ;\n" + good, "nc.not_understood p:8"},
        {"5:  !tie on ;\n" + good, "nc.tie_on p:8"},
        {"/APPL\n", "nc.not_understood p:8"},
    };
    for (const auto& c : cases) {
        EXPECT_EQ(refused_lines(c.lines), c.said) << c.lines;
    }
    const BlockList list = Tp().read(kStart + good + kPositions + position(3, "-.250") + "/END\n",
                                     "p", machine_for("tp"));
    ASSERT_EQ(list.blocks.size(), 3U);
    EXPECT_EQ(list.value(2, 0), -0.25);
    EXPECT_EQ(list.blocks[1].line, 7);
    EXPECT_EQ(list.blocks[2].duration_s, 0.5);
}

TEST(TpRead, NamesTheLineOfAPositionThatItRefuses) {
    ASSERT_EQ(refused_position(position(3, "2.000")), "accepted");
    const std::string arm = "J1=0 deg,J2=0 deg,J3=0 deg,J4=0 deg,J5=0 deg,J6=0 deg";  // on one line
    const auto third = [&](const std::string& axes) {
        return refused_position("P[3]{" + kFrame + axes + "};\n");
    };
    EXPECT_EQ(third(arm + ",E1=2 deg"), "accepted");
    EXPECT_EQ(third("E1 = 2. deg , " + arm), "accepted");
    EXPECT_EQ(third(arm), "nc.no_axis p:24");
    EXPECT_EQ(third(arm + ",E1=2 deg,E2=0 mm"), "nc.no_axis p:26");
    EXPECT_EQ(third(arm + ",E1=2 deg,J1=0 deg"), "nc.word_twice p:26");
    EXPECT_EQ(third(arm + ",E1=2 mm"), "nc.not_understood p:26");
    EXPECT_EQ(third(arm + ",E1=2"), "nc.not_understood p:26");
    EXPECT_EQ(third(arm + ",E1=2e1 deg"), "nc.not_understood p:26");
    EXPECT_EQ(third(arm + ",E1=******** deg"), "nc.not_understood p:26");
    EXPECT_EQ(third(arm + ",E1=1.2.3 deg"), "nc.number p:26");
    EXPECT_EQ(third(arm + "E1=2 deg"), "nc.not_understood p:26");
    EXPECT_EQ(third(arm + ",E1=2 deg,"), "nc.not_understood p:26");
    EXPECT_EQ(third("CONFIG : 'N U T, 0, 0, 0', X = 1 mm"), "nc.not_understood p:26");
    EXPECT_EQ(third("J2=-9000000000 deg,J3=9000000000 deg,J1=0 deg,J4=0 deg,J5=0 deg,J6=0 deg,"
                    "E1=2 deg"),
              "nc.number p:26");
    // What a block may do is said of its instruction.
    EXPECT_EQ(third(arm + ",E1=2.0005 deg"), "nc.resolution p:8");
    EXPECT_EQ(third(arm + ",E1=7200001.6 deg"), "nc.too_far p:8");
    EXPECT_EQ(refused_position(position(2, "2.000")), "nc.no_position p:24");
    EXPECT_EQ(refused_position("P[3]{" + kFrame + arm + ",E1=2 deg\n   GP2:\n};\n"),
              "nc.not_understood p:27");
    EXPECT_EQ(refused_position("P[3]{\n   GP1:\n\tUF : 0, UT : 2,\n" + arm + ",E1=2 deg};\n"),
              "nc.not_understood p:26");
    EXPECT_EQ(refused_position("P[3]{\n};\n"), "nc.not_understood p:25");
    EXPECT_EQ(refused_position("P[x]{\n};\n"), "nc.not_understood p:24");
    EXPECT_EQ(refused_position("words\n"), "nc.not_understood p:24");
    EXPECT_EQ(refused_position(""), "nc.no_position p:8");
}

TEST(TpRead, TheFrameIsWhole) {
    const std::string all = kStart + kPositions + "/END\n";
    ASSERT_EQ(refusal(all), "accepted");
    EXPECT_EQ(refusal(all + "\n \n"), "accepted");
    EXPECT_EQ(refusal(all + "/END\n"), "nc.not_understood p:24");
    EXPECT_EQ(refusal(kStart + kPositions), "nc.no_end p:22");
    EXPECT_EQ(refusal(kStart), "nc.no_end p:7");
    EXPECT_EQ(refusal(""), "nc.no_end p:0");
    EXPECT_EQ(Tp().code_of("/MN\n!\n:;\n1:!;\n", "p"), "!\n");
    EXPECT_EQ(refusal("/ATTR\n" + all), "nc.not_understood p:1");
    const auto changed = [&](const std::string& from, const std::string& by) {
        std::string text = all;
        text.replace(text.find(from), from.size(), by);
        return refusal(text);
    };
    EXPECT_EQ(changed("DEFAULT_GROUP\t= 1,*,*,*,*;\n", ""), "nc.no_axis p:2");
    EXPECT_EQ(changed("1,*,*,*,*", "1,1,*,*,*"), "nc.no_axis p:2");
    EXPECT_EQ(changed("/MN", "/APPL\n  words ;\n/MN"), "accepted");
    EXPECT_EQ(changed("/MN", "/POS"), "nc.not_understood p:3");
    EXPECT_EQ(changed("UFRAME_NUM=0", "UFRAME_NUM=1"), "nc.not_understood p:4");
    EXPECT_EQ(changed("   2:  UTOOL_NUM=1 ;\n", ""), "nc.not_understood p:5");
    EXPECT_EQ(changed("   3:J P[1] 10% FINE    ;\n", ""), "nc.unknown_start p:6");
    EXPECT_EQ(changed("   4:J P[2] 500msec CNT100    ;\n", ""), "nc.no_motion p:6");
}

// A line left out or doubled, or a number of it changed, is refused or read as something else.
TEST(TpRead, EveryChangeOfALineIsSeen) {
    const Machine machine = machine_for("tp");
    const std::string text = Tp().write(machine, test::small_program(machine),
                                        {.tie_on_mm = Eigen::Vector3d(70.0, 0.0, -1.5)});
    const std::string code = Tp().code_of(text, "p");
    const BlockList whole = Tp().read(text, "p", machine);
    const auto is_seen = [&](const std::string& changed) {
        EXPECT_NE(Tp().code_of(changed, "p"), code);
        return test::reads_otherwise(Tp(), machine, changed, whole);
    };
    std::size_t begin = text.find("DEFAULT_GROUP");
    for (const std::string& line : test::split_lines(text.substr(begin))) {
        const std::size_t size = line.size() + 1;
        if (line.find('!') == std::string::npos && line.rfind("CONTROL_CODE", 0) != 0) {
            SCOPED_TRACE(line);
            EXPECT_TRUE(is_seen(std::string(text).erase(begin, size)));
            // A second move to the start, or stop, leads to where the first did.
            EXPECT_TRUE(line.find("P[1] 10%") != std::string::npos ||
                        line.find("PAUSE") != std::string::npos ||
                        line.rfind("DEFAULT_GROUP", 0) == 0 ||
                        is_seen(std::string(text).insert(begin, line + "\n")));
            for (const char* end : {"msec", " deg"}) {
                if (const std::size_t at = line.find(end); at != std::string::npos) {
                    std::string moved = text;
                    char& digit = moved[begin + at - 1];
                    digit = digit == '7' ? '3' : '7';
                    EXPECT_TRUE(is_seen(moved));
                }
            }
        }
        begin += size;
    }
}

}  // namespace
}  // namespace meshwind
