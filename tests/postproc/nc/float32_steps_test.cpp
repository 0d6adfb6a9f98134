#include "postproc/nc/float32_steps.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "core/error.h"
#include "postproc/nc/nc_dialects.h"
#include "tests/support/block_lists.h"
#include "tests/support/dialect_lists.h"

namespace meshwind {
namespace {

using test::add;
using test::empty_list;
using test::machine_for;

// C alone, by equal steps of 1e-9 deg.
BlockList turns(const Machine& machine, std::int64_t step_nano, int count) {
    BlockList list = empty_list(machine);
    const std::int64_t resolution = list.axes[0].resolution_nano;
    for (int i = 0; i <= count; ++i) {
        add(list, {i * (step_nano / resolution), 0, 0, 0, 0, 0}, i == 0 ? 0.0 : 0.1);
    }
    return list;
}

// What the parsers of grbl-Mega-5X and of grblHAL's simulator were measured to have for C after so
// many increments of 3.6123 deg: off by +0.004, +0.013, -3.5, -1.5, -30 and +193 deg.
TEST(Float32Steps, ModelGivesWhatFirmwaresWereMeasuredToDo) {
    Machine machine = machine_for("grbl");
    machine.mandrel_chain[0].resolution_nano = 100'000;
    struct Row {
        int count;
        double off_deg;
        double digits_deg;
    };
    for (const Row& row :
         {Row{1000, 0.004, 5e-4}, Row{3000, 0.013, 5e-4}, Row{10'000, -3.5, 0.05},
          Row{12'000, -1.5, 0.05}, Row{30'000, -30.0, 0.5}, Row{100'000, 193.0, 0.5}}) {
        const BlockList list = turns(machine, 3'612'300'000, row.count);
        const std::string text = Grbl().write(machine, list, {}, {});
        for (const auto summation : {test::Summation::GrblFloats, test::Summation::MarlinFloats}) {
            const double end = test::end_of_program(text, machine, summation)[0];
            EXPECT_NEAR(end - 3.6123 * row.count, row.off_deg, row.digits_deg) << row.count;
            // The model's worst place is no better than the end.
            EXPECT_GE(float32_error(list, 0, Float32Text::ByHundreds) + 1e-9,
                      std::abs(end - 3.6123 * row.count));
        }
    }
}

TEST(Float32Steps, ReachSaysHowFineTheyAre) {
    const Machine machine = machine_for("grbl");
    struct Row {
        int count;
        double grbl;
        double marlin;
    };
    for (const Row& row :
         {Row{9000, 64.0, 256.0}, Row{30'000, 64.0, 128.0}, Row{72'000, 64.0, 64.0},
          Row{73'000, 32.0, 32.0}, Row{200'000, 16.0, 16.0}}) {
        const BlockList list = turns(machine, 3'612'000'000, row.count);
        EXPECT_EQ(with_binary_steps(list, grbl_flavour()).axes[0].resolution_nano,
                  std::llround(1e9 / row.grbl))
            << row.count;
        const BlockList marlin = with_binary_steps(list, marlin_flavour());
        EXPECT_EQ(marlin.axes[0].resolution_nano, std::llround(1e9 / row.marlin)) << row.count;
        EXPECT_EQ(float32_error(marlin, 0, Float32Text::Rounded), 0.0);
        EXPECT_EQ(marlin.axes[1], list.axes[1]);  // rests
        for (std::size_t b = 0; b < list.blocks.size(); ++b) {
            ASSERT_LE(std::abs(marlin.row(b)[0] - list.row(b)[0]),
                      marlin.axes[0].resolution_nano / 2);
        }
    }
}

TEST(Float32Steps, RefusesWhatNoStepReaches) {
    const Machine machine = machine_for("marlin");
    const BlockList list = turns(machine, 36'123'000'000, 30'000);  // 1 083 690 deg
    try {
        (void)with_binary_steps(list, marlin_flavour());
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), "dialect.float32");
        EXPECT_NE(std::string(error.what()).find("1083690"), std::string::npos);
    }
    // A machine of quarter degrees loses nothing there.
    Machine coarse = machine;
    coarse.mandrel_chain[0].resolution_nano = kNanoPerUnit / 4;
    const BlockList quarters = turns(coarse, 36'250'000'000, 30'000);
    EXPECT_EQ(with_binary_steps(quarters, marlin_flavour()).nano, quarters.nano);
}

// A carriage there and back loses a little, less than coarse steps would: the head says so.
TEST(Float32Steps, AreNotTakenWhereTheyAreWorse) {
    const Machine machine = machine_for("grbl");
    BlockList list = empty_list(machine);
    add(list, {0, 0, 0, 100'000, 0, 0}, 0.0);
    std::int64_t z = 0;
    for (int i = 0; i < 20'000; ++i) {
        z += i % 400 < 200 ? 4001 : -4001;
        add(list, {0, z, 0, 100'000, 0, 0}, 0.1);
    }
    const double error = float32_error(list, 1, Float32Text::ByHundreds);
    EXPECT_GT(error, 0.0005);
    EXPECT_LT(error, 0.5 / 64.0);
    EXPECT_EQ(Grbl().prepare(list).axes, list.axes);
    const std::string text = Grbl().write(machine, list, {.version = "test"});
    EXPECT_NE(text.find("(axis Z is off by up to 0.00"), std::string::npos);
    EXPECT_EQ(text.find("(axis C"), std::string::npos);
}

TEST(Float32Steps, BlocksThatComeToRestGoWithTheNext) {
    const Machine machine = machine_for("grbl");
    BlockList list = turns(machine, 3'612'000'000, 30'000);
    const std::size_t axes = list.axes.size();
    for (int i = 1; i <= 10; ++i) {
        list.blocks.push_back({.duration_s = 0.1, .piece = 7, .point = i});
        std::vector<std::int64_t> row(list.nano.end() - static_cast<std::ptrdiff_t>(axes),
                                      list.nano.end());
        row[0] += 1'000'000;
        list.nano.insert(list.nano.end(), row.begin(), row.end());
    }
    const BlockList stepped = with_binary_steps(list, grbl_flavour());
    EXPECT_LT(stepped.blocks.size(), list.blocks.size());
    EXPECT_NEAR(stepped.duration_s(), list.duration_s(), 1e-9);
    EXPECT_EQ(with_binary_steps(stepped, grbl_flavour()).nano, stepped.nano);
}

TEST(Float32Steps, StartOfManyDigitsIsWrittenInTwoMoves) {
    Machine machine = machine_for("grbl");
    machine.mandrel_chain[0].resolution_nano = 15'625'000;
    BlockList list = empty_list(machine);
    add(list, {-1000 * 64 - 1, 0, 0, 100'000, 0, 0}, 0.0);
    add(list, {-910 * 64 + 1, 0, 0, 100'000, 0, 0}, 100.0);
    const std::string text = Grbl().write(machine, list, {});
    EXPECT_NE(text.find("G90 G0 A0.000 B0.000 C-1000\nG91 G0 C-0.015625\nG90 G0 X"),
              std::string::npos);
    EXPECT_NE(text.find("\nM0\nG91 G93\n"), std::string::npos);
    EXPECT_NE(text.find("G1 C90.031250 F0.6\n"), std::string::npos);
    EXPECT_EQ(Grbl().read(text, "p", machine).nano, list.nano);
}

// A move of 100 deg or more has no room for six decimals, one of 1000 none for five.
TEST(Float32Steps, LongMovesTakeCoarserStepsOrAreSplit) {
    Machine machine = machine_for("grbl");
    for (const double step : {0.001, 1.0 / 64.0}) {
        machine.mandrel_chain[0].resolution_nano = std::llround(1e9 * step);
        for (const auto& [move_deg, coarse] :
             {std::pair(99.123, 64.0), std::pair(120.321, 32.0), std::pair(2000.123, 16.0)}) {
            const auto count = static_cast<int>(200'000.0 / move_deg);
            const BlockList list = turns(machine, std::llround(1e9 * move_deg), count);
            const BlockList prepared = Grbl().prepare(list);
            EXPECT_EQ(prepared.axes[0].resolution_nano, std::llround(1e9 / coarse)) << move_deg;
            EXPECT_EQ(prepared.blocks.size(), list.blocks.size());
            EXPECT_EQ(Grbl().prepare(prepared).nano, prepared.nano);
            EXPECT_EQ(Grbl().read(Grbl().write(machine, list, {}), "p", machine).nano,
                      prepared.nano);
        }
    }
    machine.mandrel_chain[0].resolution_nano = 10'000;  // five decimals
    const BlockList list = turns(machine, 2'500'000'000'000, 1);
    const BlockList prepared = Grbl().prepare(list);
    EXPECT_EQ(prepared.blocks.size(), 4u);
    EXPECT_EQ(prepared.nano.back(), list.nano.back());
    EXPECT_NEAR(prepared.duration_s(), list.duration_s(), 1e-12);
    EXPECT_EQ(Grbl().prepare(prepared).nano, prepared.nano);
}

TEST(Float32Steps, ReaderFindsTheStep) {
    const Machine machine = machine_for("grbl");
    BlockList list = turns(machine, 0, 0);
    list.axes[0].resolution_nano = 31'250'000;
    add(list, {3, 1, 0, 0, 0, 0}, 1.0);
    const BlockList read = Grbl().read(Grbl().write(machine, list, {}, {}), "p", machine);
    EXPECT_EQ(read.nano, list.nano);
    EXPECT_EQ(read.axes, list.axes);
}

}  // namespace
}  // namespace meshwind
