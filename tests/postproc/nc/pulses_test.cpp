#include "postproc/nc/pulses.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/block_lists.h"
#include "tests/support/dialect_lists.h"

namespace meshwind {
namespace {

using test::add;
using test::empty_list;
using test::machine_for;

const std::string kHead =
    "; head\naxes C Z Y X A B\nstep 0.001 0.001 0.001 0.001 0.001 0.001\ntick_s 0.01\n"
    "start -1.5 0 0 100 0 0\n";

std::string refusal(const std::string& text) {
    try {
        (void)Pulses().read(text, "p", machine_for("pulses"));
    } catch (const InputError& error) {
        return error.code() + " " + error.place();
    }
    return "accepted";
}

TEST(Pulses, WritesThisTable) {
    const Machine machine = machine_for("pulses");
    BlockList list = empty_list(machine);
    add(list, {-1500, 0, 0, 100'000, 0, 0}, 0.0);
    add(list, {-1490, -10, 0, 100'001, 0, 0}, 0.032, 0);
    add(list, {-1490, -9, 0, 100'001, 0, 0}, 0.01, 1);
    EXPECT_EQ(Pulses().write(machine, list, {.version = "test"}),
              "; meshwind test\n; machine: Six-axis winder\n; fibre: 0.000 m\n; time: 0.1 s\n"
              "; blocks: 2\n"
              "axes C Z Y X A B\nstep 0.001 0.001 0.001 0.001 0.001 0.001\ntick_s 0.01\n"
              "start -1.500 0.000 0.000 100.000 0.000 0.000\n"
              "; course 0\nblock 4\n3 -3 0 0 0 0\n2 -2 0 1 0 0\n3 -3 0 0 0 0\n2 -2 0 0 0 0\n"
              "; course 1\nblock 1\n0 1 0 0 0 0\nend\n");
}

// At every tick the sum of pulses is within half a step of the straight line of the block, by an
// own reading of the table.
TEST(Pulses, RunningSumIsWithinHalfAStepOfTheBlocks) {
    Machine machine = machine_for("pulses");
    machine.eye_chain[2].resolution_nano = 12'500'000;
    const BlockList list = Pulses().prepare(test::random_list(machine, 4, 2000));
    std::istringstream text(Pulses().write(machine, list, {}));
    std::vector<long> sum(6, 0);
    std::size_t block = 0;
    long ticks = 0;
    long tick = 0;
    for (std::string line; std::getline(text, line);) {
        if (line.substr(0, 6) == "block ") {
            ASSERT_EQ(tick, ticks);
            ++block;
            ticks = std::strtol(line.c_str() + 6, nullptr, 10);
            tick = 0;
            EXPECT_NEAR(0.01 * static_cast<double>(ticks), list.blocks[block].duration_s, 1e-9);
        } else if (line[0] == '-' || (line[0] >= '0' && line[0] <= '9')) {
            std::istringstream numbers(line);
            ++tick;
            for (std::size_t a = 0; a < 6; ++a) {
                long pulses = 0;
                numbers >> pulses;
                sum[a] += pulses;
                const double step = static_cast<double>(list.axes[a].resolution_nano) / 1e9;
                const double share = static_cast<double>(tick) / static_cast<double>(ticks);
                const double from = list.value(block - 1, a) - list.value(0, a);
                const double to = list.value(block, a) - list.value(0, a);
                ASSERT_NEAR(static_cast<double>(sum[a]), (from + share * (to - from)) / step,
                            0.5 + 1e-6);
            }
        }
    }
    EXPECT_EQ(block + 1, list.blocks.size());
    for (std::size_t a = 0; a < 6; ++a) {
        EXPECT_EQ(sum[a] * list.axes[a].resolution_nano, list.row(block)[a] - list.row(0)[a]);
    }
}

TEST(Pulses, BlocksLastWholeTicksAndNeverLess) {
    const Machine machine = machine_for("pulses");
    const BlockList list = test::random_list(machine, 2, 1000);
    const BlockList prepared = Pulses().prepare(list);
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        const double ticks = prepared.blocks[i].duration_s / kPulseTick_s;
        EXPECT_NEAR(ticks, std::round(ticks), 1e-6);
        EXPECT_GE(prepared.blocks[i].duration_s, list.blocks[i].duration_s - 1e-7);
        EXPECT_LT(prepared.blocks[i].duration_s, list.blocks[i].duration_s + kPulseTick_s);
    }
}

TEST(PulsesRead, NamesTheLineOfWhatItRefuses) {
    const std::string block = "block 2\n1 0 0 0 0 0\n1 0 0 -1 0 0\n";
    EXPECT_EQ(refusal(kHead + block + "end\n"), "accepted");
    EXPECT_EQ(refusal(kHead + "block 2 ; words\n  1 0 0 0 0 0\n1  0 0 -1 0 0 ; tick\nend"),
              "accepted");
    EXPECT_EQ(refusal(kHead + block), "nc.no_end p:8");
    EXPECT_EQ(refusal(kHead + "end\n"), "nc.no_motion p:6");
    EXPECT_EQ(refusal(kHead + block + "end\nend\n"), "nc.pulses p:10");
    EXPECT_EQ(refusal(kHead + "block 3\n1 0 0 0 0 0\nend\n"), "nc.pulses p:8");
    EXPECT_EQ(refusal(kHead + "block 0\nend\n"), "nc.pulses p:6");
    EXPECT_EQ(refusal(kHead + "block 1\n1 0 0 0 0\nend\n"), "nc.pulses p:7");
    EXPECT_EQ(refusal(kHead + "block 1\n1.5 0 0 0 0 0\nend\n"), "nc.pulses p:7");
    EXPECT_EQ(refusal(kHead + "block 2\n5 0 0 0 0 0\n1 0 0 0 0 0\nend\n"), "nc.pulses p:8");
    EXPECT_EQ(refusal(kHead + "1 0 0 0 0 0\nend\n"), "nc.pulses p:6");
    EXPECT_EQ(refusal("axes C Z Y X A\n"), "nc.pulses p:1");
    EXPECT_EQ(refusal("axes C Z Y X A A\n"), "nc.pulses p:1");
    EXPECT_EQ(refusal("axes B A X Y Z C\nstep 1 1 1 1 1 0.0005\n"), "nc.resolution p:2");
    EXPECT_EQ(refusal("axes B A X Y Z C\nstep 1 1 1 1 1 0\n"), "nc.resolution p:2");
    EXPECT_EQ(refusal("axes B A X Y Z C\nstep 1 1 1 1 1 1\ntick_s 0\n"), "nc.pulses p:3");
    EXPECT_EQ(refusal(kHead + "; tie on\n"), "nc.tie_on p:6");
    Machine machine = machine_for("pulses");
    machine.controller.header = {"G64"};
    EXPECT_THROW((void)Pulses().write(machine, test::random_list(machine, 1, 3), {}), InputError);
}

TEST(PulsesRead, ColumnsMayStandInAnyOrder) {
    const Machine machine = machine_for("pulses");
    const BlockList list = Pulses().read(
        "axes B A X Y Z C\nstep 0.001 0.001 0.01 0.001 0.001 0.5\ntick_s 0.005\nstart 1 2 3 4 5 6\n"
        "; course 3\nblock 2\n0 0 1 0 0 -1\n0 0 1 0 0 0\nend\n",
        "p", machine);
    EXPECT_EQ(list.value(0, *machine.joint_of('C')), 6.0);
    EXPECT_EQ(list.value(1, *machine.joint_of('C')), 5.5);
    EXPECT_EQ(list.value(1, *machine.joint_of('X')), 3.02);
    EXPECT_DOUBLE_EQ(list.blocks[1].duration_s, 0.01);
    EXPECT_EQ(list.blocks[1].piece, 3);
    EXPECT_EQ(list.blocks[1].line, 6);
}

}  // namespace
}  // namespace meshwind
