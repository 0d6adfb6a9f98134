// RAPID: what is written for ABB's controllers, and what is refused when it is read back.
#include "postproc/robot/rapid.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "machines/machine_json.h"
#include "postproc/robot/dialects.h"
#include "postproc/robot/rapid_tokens.h"
#include "tests/support/block_lists.h"
#include "tests/support/dialect_lists.h"

namespace meshwind {
namespace {

using test::add;
using test::empty_list;
using test::machine_for;

const std::string kData =
    "CONST speeddata approach:=[50,20,50,30];\nCONST zonedata corner:=[FALSE,10,15,15,15,15,45];\n";
const std::string kUnused = ",9E9,9E9,9E9,9E9,9E9]]";

// Lines 1 to 4 and 6 to 9 stand around line 5 and what is given for line 8.
const std::string kStart = "MODULE m\n" + kData + "PROC main()\nMoveAbsJ [[0,0,0,0,0,0],[0" +
                           kUnused + ",v50,fine,tool0;\nStop;\n! course 4\n";
const std::string kEnd = "ENDPROC\nENDMODULE\n";

// A block that takes the spindle there.
std::string block(const std::string& x, const std::string& rest = "\\T:=0.5,corner,tool0;\n") {
    return "MoveAbsJ [[0,0,0,0,0,0],[" + x + kUnused + "\\NoEOffs,v1000" + rest;
}

// In the second block's place.
std::string with_second(const std::string& lines) {
    return std::string(kStart).append(block("1.5")).append(lines).append(kEnd);
}

std::string refusal(const std::string& text) {
    try {
        (void)Rapid().read(text, "p", machine_for("rapid"));
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.code() + " " + error.place();
    }
    return "accepted";
}

std::string refused_machine(const Machine& machine) {
    try {
        Rapid().check(machine);
    } catch (const InputError& error) {
        return error.code() + ": " + error.words();
    }
    return "taken";
}

TEST(Rapid, WritesThisProgram) {
    const Machine machine = machine_for("rapid");
    BlockList list = empty_list(machine);
    add(list, {-5015, 3113, -29088, 0, 0, 0, 43004}, 0.0);
    add(list, {-26711, 2391, -29119, 1, 0, 0, 43495}, 0.0865582, 0);
    add(list, {-26711, 2391, -29119, 1, 0, -1, 43495}, 2.0, 1);
    EXPECT_EQ(
        Rapid().write(machine, list, {.version = "test"}),
        "MODULE meshwind\n! meshwind test\n! machine: Robot in front of a spindle\n"
        "! fibre: 0.000 m\n! time: 2.1 s\n! blocks: 2\n"
        "! axes 1 to 6: A B C U V W; external: X is eax_a\n" +
            kData +
            "PROC main()\n! approach: all axes move together;\n"
            "! bring the eye clear of the mandrel by hand before the start\n"
            "MoveAbsJ [[3.113,-29.088,0.000,0.000,0.000,43.004],[-5.015,9E9,9E9,9E9,9E9,9E9]]"
            "\\NoEOffs,approach,fine,tool0;\n"
            "TPWrite \"tie the fibre on at the landing point, then start again\";\nStop;\n"
            "! course 0\n"
            "MoveAbsJ [[2.391,-29.119,0.001,0.000,0.000,43.495],[-26.711,9E9,9E9,9E9,9E9,9E9]]"
            "\\NoEOffs,v1000\\T:=0.0865582,corner,tool0;\n"
            "! course 1\n"
            "MoveAbsJ [[2.391,-29.119,0.001,0.000,-0.001,43.495],[-26.711,9E9,9E9,9E9,9E9,9E9]]"
            "\\NoEOffs,v1000\\T:=2,fine,tool0;\n"
            "ENDPROC\nENDMODULE\n");
}

TEST(Rapid, HeadAndApproachAreRead) {
    const Machine machine = machine_for("rapid");
    const BlockList planned = test::small_program(machine);
    const std::string text = Rapid().write(machine, planned,
                                           {.version = "test",
                                            .job_digest = "sha256/128 01",
                                            .code_digest = "sha256/128 02",
                                            .tie_on_mm = Eigen::Vector3d(70.0, 0.0, -1.5)});
    const BlockList read = Rapid().read(text, "p", machine);
    EXPECT_TRUE(read.head->by_meshwind);
    EXPECT_TRUE(read.head->has_approach);
    EXPECT_EQ(read.head->job_digest, "sha256/128 01");
    EXPECT_EQ(read.head->code_digest, "sha256/128 02");
    ASSERT_EQ(read.head->approach.size(), 1U);
    EXPECT_EQ(read.head->approach.front().nano,
              std::vector<std::int64_t>(planned.row(0).begin(), planned.row(0).end()));
    EXPECT_EQ(read.head->stop_line, read.head->approach.front().line + 2);
    // A move behind the stop leads elsewhere: the stop is no longer where the fibre is tied on.
    std::string moved = text;
    const std::size_t stop = moved.find("Stop;\n");
    moved.insert(stop + 6, "MoveAbsJ [[0,0,0,0,0,0],[0" + kUnused + ",v50,fine,tool0;\n");
    EXPECT_EQ(Rapid().read(moved, "p", machine).head->stop_line, 0);
    EXPECT_FALSE(Rapid().read(kStart + block("1") + kEnd, "p", machine).head->by_meshwind);
}

TEST(Rapid, AxesOfTheChainsAreTheRobotsAndExternalOnes) {
    const auto shipped = [](const std::string& name) {
        return read_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/" + name + ".json");
    };
    Machine track = shipped("robot_track");
    track.controller.dialect = "rapid";
    BlockList list = empty_list(track);
    add(list, {1000, 2000, 1, 2, 3, 4, 5, 6}, 0.0);
    add(list, {1001, 2000, 1, 2, 3, 4, 5, 6}, 1.0);
    const std::string text = Rapid().write(track, list, {});
    EXPECT_NE(text.find("! axes 1 to 6: A B C U V W; external: X is eax_a, Z is eax_b\n"),
              std::string::npos);
    EXPECT_NE(text.find("[[0.001,0.002,0.003,0.004,0.005,0.006],[1.001,2.000,9E9,9E9,9E9,9E9]]"),
              std::string::npos);
    EXPECT_EQ(Rapid().read(text, "p", track).nano, list.nano);
    const std::string chain = "dialect.robot_axes: its eye chain has 5 axes";
    EXPECT_EQ(refused_machine(shipped("six_axis")).substr(0, chain.size()), chain);
    std::swap(track.eye_chain[0], track.eye_chain[1]);
    EXPECT_EQ(refused_machine(track).substr(0, 43), "dialect.robot_axes: axis Z would be axis 1 ");
    Machine many = machine_for("rapid");
    while (many.mandrel_chain.size() < 7) {
        many.mandrel_chain.push_back(many.mandrel_chain.front());
    }
    EXPECT_EQ(refused_machine(many).substr(0, 26), "dialect.robot_axes: it has");
}

// What the controller calls axis 1 or eax_b is what the machine file says.
TEST(Rapid, AxesMayBeNamed) {
    const auto with = [](const std::string& robot, const std::string& external) {
        Machine machine =
            read_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/robot_track.json");
        machine.controller.dialect = "rapid";
        machine.controller.robot_axes = robot;
        machine.controller.external_axes = external;
        return machine;
    };
    const auto line_of = [](const Machine& machine, const std::string& begin) {
        BlockList list = empty_list(machine);
        add(list, {1000, 2000, 1, 2, 3, 4, 5, 6}, 0.0);  // X Z A B C U V W
        add(list, {1001, 2000, 1, 2, 3, 4, 5, 6}, 1.0);
        const std::string text = Rapid().write(machine, list, {});
        EXPECT_EQ(Rapid().read(text, "p", machine).nano, list.nano);
        const std::size_t at = text.find(begin);
        return text.substr(at, text.find('\n', at) - at);
    };
    const Machine named = with("WVUCBA", "Z--X");
    EXPECT_EQ(line_of(named, "! axes"),
              "! axes 1 to 6: W V U C B A; external: Z is eax_a, X is eax_d");
    const std::string move =
        "MoveAbsJ [[0.006,0.005,0.004,0.003,0.002,0.001],"
        "[2.000,9E9,9E9,1.000,9E9,9E9]]";
    EXPECT_EQ(line_of(named, "MoveAbsJ").substr(0, move.size()), move);
    EXPECT_EQ(line_of(with("", "ZX"), "! axes"),
              "! axes 1 to 6: A B C U V W; external: Z is eax_a, X is eax_b");
    EXPECT_EQ(line_of(with("ABCUVX", ""), "! axes"),
              "! axes 1 to 6: A B C U V X; external: Z is eax_a, W is eax_b");
    const struct {
        const char* robot;
        const char* external;
        const char* said;
    } cases[] = {
        {"ABCUVZ", "", "dialect.robot_axes: axis Z would be axis 6 "},
        {"", "Z", "dialect.robot_axes: axis X has no number"},
        {"", "ZXW", "dialect.robot_axes: axis W is one of the robot's six"},
    };
    for (const auto& c : cases) {
        const std::string words = refused_machine(with(c.robot, c.external));
        EXPECT_EQ(words.substr(0, std::string(c.said).size()), c.said);
    }
    // Other languages have no use for the names, and the file may keep them.
    Machine siemens = with("ABCUVW", "ZX");
    EXPECT_NO_THROW(make_dialect("siemens")->check(siemens));
}

// The controller reads every number into a 32-bit float. What that takes off is no more than the
// head says, at any block: absolute positions do not add up.
TEST(Rapid, PositionsInFloatsAreAsFarOffAsTheHeadSays) {
    const Machine machine = machine_for("rapid");
    for (const double turns_deg : {8'000.0, 60'000.0, 1'000'000.0}) {
        SCOPED_TRACE(turns_deg);
        BlockList list = empty_list(machine);
        std::mt19937 random(1);
        constexpr int kBlocks = 4000;
        for (int i = 0; i <= kBlocks; ++i) {
            const double x =
                turns_deg * (i + 1e-4 * static_cast<double>(random() % 1000)) / (kBlocks + 1);
            add(list, {std::llround(1000.0 * x), i, 0, 0, 0, 0, 0}, i == 0 ? 0.0 : 0.1);
        }
        const std::string text = Rapid().write(machine, list, {});
        double worst = 0.0;
        std::size_t at = 0;
        for (std::size_t b = 0; b < list.blocks.size(); ++b) {
            at = text.find("],[", at) + 3;
            const float held = std::strtof(text.c_str() + at, nullptr);
            worst = std::max(worst, std::abs(static_cast<double>(held) - list.value(b, 0)));
        }
        // Half of the last of 24 bits.
        const double half = std::exp2(std::floor(std::log2(turns_deg)) - 24.0);
        EXPECT_LE(worst, half);
        EXPECT_GT(worst, 0.5 * half);
        const std::size_t note = text.find("! note: axis X is off by up to ");
        ASSERT_EQ(note != std::string::npos, worst > 0.0005);
        if (note != std::string::npos) {
            EXPECT_NEAR(std::strtod(text.c_str() + note + 31, nullptr), worst, 5.1e-5);
        }
        EXPECT_EQ(Rapid().prepare(list).nano, list.nano);
    }
    BlockList far = empty_list(machine);
    add(far, {0, 0, 0, 0, 0, 0, 0}, 0.0);
    add(far, {2'000'000'060, 0, 0, 0, 0, 0, 0}, 1e4);
    EXPECT_THROW((void)Rapid().prepare(far), InputError);
}

TEST(Rapid, OwnLines) {
    const auto with = [](const std::string& line) {
        Machine machine = machine_for("rapid");
        machine.controller.header = {line};
        const std::string words = refused_machine(machine);
        return words.substr(0, words.find(':'));
    };
    for (const char* line : {"", "! words; \"and others", "AccSet 50,50;", "ConfJ \\Off; SingArea",
                             "ActUnit STN1;", "SetDO doTension,1; SetAO aoTension , 12.5;",
                             "TPWrite \"{mandrel} ! now\";", "GripLoad load0; ! the head"}) {
        EXPECT_EQ(with(line),
                  std::string(line) == "ConfJ \\Off; SingArea" ? "dialect.header_line" : "taken")
            << line;
    }
    for (const char* line :
         {"MoveAbsJ home,v100,fine,tool0;", "MoveL p1,v100,fine,tool0;", "WaitTime 5;", "ENDPROC",
          "AccSet 50,50", "AccSet 50,f(50);", "TPWrite \"open;", "IF TRUE Stop;", "Stop;",
          "! tie on here", "! tie on at X1.000 Y2.000 Z3.000 on the mandrel", "VelSet 10,100;",
          "! caf\xc3\xa9"}) {
        EXPECT_EQ(with(line), "dialect.header_line") << line;
    }
    Machine machine = machine_for("rapid");
    machine.controller.header = {"ActUnit STN1;"};
    machine.controller.footer = {"DeactUnit STN1;"};
    const BlockList list = test::small_program(machine);
    const std::string text = Rapid().write(machine, list, {});
    EXPECT_LT(text.find("ActUnit"), text.find("MoveAbsJ"));
    EXPECT_GT(text.find("DeactUnit"), text.rfind("MoveAbsJ"));
    EXPECT_EQ(Rapid().read(text, "p", machine).nano, list.nano);
}

TEST(RapidRead, NamesTheLineOfWhatItRefuses) {
    const std::string good = kStart + block("1.5") + block("3") + kEnd;
    ASSERT_EQ(refusal(good), "accepted");
    const BlockList list = Rapid().read(good, "p", machine_for("rapid"));
    EXPECT_EQ(list.blocks.size(), 3U);
    EXPECT_EQ(list.value(1, 0), 1.5);
    EXPECT_EQ(list.blocks[1].piece, 4);
    EXPECT_EQ(list.blocks[1].line, 8);
    EXPECT_EQ(list.blocks[2].duration_s, 0.5);

    const struct {
        const char* second;
        const char* said;
    } blocks[] = {
        {"MoveL p1,v100,fine,tool0;\n", "nc.not_understood p:9"},
        {"MoveAbsJ p1\\NoEOffs,v1000\\T:=1,corner,tool0;\n", "nc.not_understood p:9"},
        {"WaitTime 1;\n", "nc.not_understood p:9"},
        {"FOR i FROM 1 TO 5 DO\n", "nc.not_understood p:9"},
        {"Stop;\n", "accepted"},
        {"TPWrite \"words ! no comment\";\n", "accepted"},
        {"! tie on\n", "nc.tie_on p:9"},
        {"! pins at rim 0\n", "nc.pins p:9"},
        {"\"\n", "nc.not_understood p:9"},
        {"ENDPROC\nPROC other()\n", "nc.not_understood p:10"},
        {"CONST num a:=1;\n", "nc.not_understood p:9"},
    };
    for (const auto& c : blocks) {
        EXPECT_EQ(refusal(with_second(c.second)), c.said) << c.second;
    }
    const struct {
        std::string text;
        const char* said;
    } moves[] = {
        {block("1.5", ",corner,tool0;\n"), "nc.rapid p:9"},
        {block("2", "\\T:=0,corner,tool0;\n"), "nc.feed p:9"},
        {block("2", "\\T:=-1,corner,tool0;\n"), "nc.not_understood p:9"},
        {block("2", "\\V:=100,corner,tool0;\n"), "nc.not_understood p:9"},
        {block("2", "\\T:=1e999,corner,tool0;\n"), "nc.feed p:9"},
        {block("2", "\\T:=5E-1,z10,tool0\\WObj:=wobj0;\n"), "accepted"},
        {block("2", "\\T:=1,z7,tool0;\n"), "nc.not_understood p:9"},
        {block("2", "\\T:=1,corner\\Z:=3,tool0;\n"), "nc.not_understood p:9"},
        {block("2", "\\T:=1,fine,tool0;\n"), "accepted"},
        {block("2", "\\T:=1,fine,tool0;\n") + block("3"), "nc.stop_point p:9"},
        {block("1.5"), "nc.feed p:9"},
        {block("9E9"), "nc.no_axis p:9"},
        {block("9E+09"), "nc.no_axis p:9"},
        {block("2E1"), "nc.number p:9"},
        {block("1.2.3"), "nc.number p:9"},
        {block("1.0005"), "nc.resolution p:9"},
        {block("- 2.5"), "accepted"},
        {block("7200001.6"), "nc.too_far p:9"},
        {block("12345678901"), "nc.number p:9"},
        {block("2,3"), "nc.no_axis p:9"},
    };
    for (const auto& c : moves) {
        EXPECT_EQ(refusal(with_second(c.text)), c.said) << c.text;
    }
    EXPECT_EQ(refusal(kStart + kEnd), "nc.no_motion p:10");
    EXPECT_EQ(refusal("MODULE m\n" + kData + "PROC main()\n" + block("1") + kEnd),
              "nc.unknown_start p:5");
    EXPECT_EQ(refusal(kStart + block("1.5") + "ENDPROC\n"), "nc.no_end p:10");
    EXPECT_EQ(refusal(""), "nc.no_end p:1");
    EXPECT_EQ(refusal(good + "PROC\n"), "nc.not_understood p:12");
    EXPECT_EQ(refusal("MODULE m\nCONST zonedata z:=[FALSE,1,1,1,1,1];\n"), "nc.not_understood p:2");
    EXPECT_EQ(refusal("MODULE m\nCONST speeddata v:=" + std::string(100'000, '[')),
              "nc.not_understood p:2");
    // A zone that stops is none to fly by.
    std::string stops = good;
    stops.replace(stops.find("FALSE"), 5, "TRUE");
    EXPECT_EQ(refusal(stops), "nc.not_understood p:8");
}

// Lines may end anywhere, and the controller saves numbers in its own way.
TEST(RapidRead, TextIsFreeOfForm) {
    const Machine machine = machine_for("rapid");
    const BlockList planned = test::small_program(machine);
    const std::string text = Rapid().write(
        machine, planned, {.version = "test", .tie_on_mm = Eigen::Vector3d(70.0, 0.0, -1.5)});
    std::string loose;
    bool comment = false;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        quoted ^= c == '"' && !comment;
        comment = (comment || (c == '!' && !quoted)) && c != '\n';
        const bool mark = !comment && !quoted && std::string("[],;\\").find(c) != std::string::npos;
        loose += mark ? std::string("\t\r\n ") + c + "\n" : std::string(1, c);
        if (!comment && !quoted && text.compare(i, 3, "9E9") == 0) {
            loose += "E+09";
            i += 2;
        }
    }
    for (const auto& [from, to] : {std::pair<std::string, std::string>{"MoveAbsJ", "MOVEABSJ"},
                                   {"ENDPROC", "EndProc"},
                                   {".000", ""}}) {
        for (std::size_t at = loose.find(from); at != std::string::npos; at = loose.find(from)) {
            // The tie-on is part of the code as it stands.
            if (loose.compare(at, from.size() + 2, ".000 Y") == 0 || loose[at - 1] == ' ') {
                break;
            }
            loose.replace(at, from.size(), to);
        }
    }
    const BlockList read = Rapid().read(loose, "p", machine);
    EXPECT_EQ(read.nano, planned.nano);
    EXPECT_EQ(read.blocks.back().piece, planned.blocks.back().piece);
    EXPECT_TRUE(Rapid().code_of(loose, "p") == Rapid().code_of(text, "p"));
}

// One token of a program left out, doubled or another number: refused, or read as something else;
// and never the same code.
TEST(RapidRead, EveryChangeOfATokenIsSeen) {
    const Machine machine = machine_for("rapid");
    const std::string text = Rapid().write(machine, test::small_program(machine),
                                           {.tie_on_mm = Eigen::Vector3d(70.0, 0.0, -1.5)});
    const std::string code = Rapid().code_of(text, "p");
    const BlockList whole = Rapid().read(text, "p", machine);
    std::vector<RapidToken> tokens;
    RapidTokens all(text, [](std::string_view, std::int32_t) {});
    for (RapidToken token = all.next(); token.kind != RapidToken::Kind::End; token = all.next()) {
        tokens.push_back(token);
    }
    ASSERT_GT(tokens.size(), 3000U);
    const std::int32_t before_blocks = whole.blocks[1].line - 1;
    const auto is_seen = [&](const std::string& changed) {
        try {
            const BlockList read = Rapid().read(changed, "p", machine);
            bool same = read.nano == whole.nano && read.blocks.size() == whole.blocks.size();
            for (std::size_t b = 0; same && b < read.blocks.size(); ++b) {
                same = read.blocks[b].duration_s == whole.blocks[b].duration_s;
            }
            return !same;
        } catch (const InputError&) {
            return true;
        }
    };
    for (std::size_t i = 0; i < tokens.size(); i += i < 60 || i + 60 > tokens.size() ? 1 : 7) {
        const RapidToken& token = tokens[i];
        const auto at = static_cast<std::size_t>(token.text.data() - text.data());
        const auto changed = [&](const std::string& by) {
            return std::string(text).replace(at, token.text.size(), by);
        };
        const std::string is(token.text);
        SCOPED_TRACE(is + " in line " + std::to_string(token.line));
        for (const std::string& by : {std::string(), std::string(is).append(" ").append(is)}) {
            // What the operator is shown is code and moves nothing.
            EXPECT_TRUE(is_seen(changed(by)) || token.kind == RapidToken::Kind::Text);
            EXPECT_NE(Rapid().code_of(changed(by), "p"), code);
        }
        if (token.kind == RapidToken::Kind::Number && token.line > before_blocks && is != "9E9") {
            const char last = is.back() == '7' ? '3' : '7';
            EXPECT_TRUE(is_seen(changed(is.substr(0, is.size() - 1) + last)));
            EXPECT_TRUE(is_seen(changed("1" + is)));
        }
    }
}

}  // namespace
}  // namespace meshwind
