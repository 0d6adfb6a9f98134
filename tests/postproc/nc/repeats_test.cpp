#include "postproc/nc/repeats.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "postproc/nc/linuxcnc.h"
#include "tests/support/block_lists.h"

namespace meshwind {
namespace {

using test::add;
using test::empty_list;
using test::pattern;
using test::six_axis;

constexpr std::int64_t kTolerance_nano = 10'000'000;  // 0.01 mm or deg

std::string write(const Machine& machine, const FoldedProgram& program) {
    return LinuxCnc().write(machine, program.list, program.layout, {.version = "test"});
}

std::size_t count(const std::string& text, const std::string& words) {
    std::size_t n = 0;
    for (std::size_t at = text.find(words); at != std::string::npos;
         at = text.find(words, at + 1)) {
        ++n;
    }
    return n;
}

// The folded list is the planned one within the tolerance, its drift is what the layout says, and
// its text runs exactly so.
void check(const Machine& machine, const BlockList& planned, const FoldedProgram& folded) {
    ASSERT_EQ(folded.list.blocks.size(), planned.blocks.size());
    std::vector<std::int64_t> drift(planned.axes.size(), 0);
    for (std::size_t i = 0; i < planned.blocks.size(); ++i) {
        ASSERT_EQ(folded.list.blocks[i].piece, planned.blocks[i].piece);
        ASSERT_NEAR(folded.list.blocks[i].duration_s, planned.blocks[i].duration_s,
                    5e-6 * planned.blocks[i].duration_s);
        for (std::size_t a = 0; a < drift.size(); ++a) {
            const std::int64_t off = std::abs(folded.list.row(i)[a] - planned.row(i)[a]);
            ASSERT_LE(off, std::max(kTolerance_nano, planned.axes[a].resolution_nano)) << i;
            drift[a] = std::max(drift[a], off);
        }
    }
    EXPECT_EQ(folded.layout.drift_nano, drift);
    const BlockList read = LinuxCnc().read(write(machine, folded), "p.ngc", machine);
    EXPECT_EQ(read.nano, folded.list.nano);
    ASSERT_EQ(read.blocks.size(), folded.list.blocks.size());
    for (std::size_t i = 1; i < read.blocks.size(); ++i) {
        ASSERT_NEAR(read.blocks[i].duration_s / folded.list.blocks[i].duration_s, 1.0, 6e-6);
    }
}

// A pattern of 233 circuits that a winding program repeats, each rounded once: the increments are
// all equal and what they lack adds up to more than half a degree. The carriage comes back exactly.
TEST(Repeats, PatternOf233CircuitsStaysWithinTheTolerance) {
    const Machine machine = six_axis();
    const BlockList planned = pattern(machine, {.circuits = 233, .advance_deg = 1234.56746});
    double once = 0.0;  // drift of C when each increment is rounded once and repeated
    for (int j = 0; j < 40; ++j) {
        const double exact = 1234.56746 / 40.0;
        once += exact - std::round(exact * 1000.0) / 1000.0;
    }
    EXPECT_GT(std::abs(once) * 233.0, 0.5);
    const FoldedProgram folded = fold_repeats(planned);
    check(machine, planned, folded);
    EXPECT_EQ(folded.layout.subprograms.size(), 2u);
    EXPECT_GT(folded.layout.drift_nano[0], kTolerance_nano / 2);
    EXPECT_EQ(folded.layout.drift_nano[1], 0);
    // 0.00046 deg are left of each circuit. 0.01 deg are reached after 21.7 of them, or 19.5 where
    // the rounding of the planned position has taken a step: 10 or 11 corrections in 233.
    const std::string text = write(machine, folded);
    EXPECT_NE(text.find("M98 P1001 L21\n"), std::string::npos);
    EXPECT_GE(count(text, "M98 P1002\n"), 11u);  // the subprogram's own call is one more
    EXPECT_LE(count(text, "M98 P1002\n"), 12u);
    EXPECT_EQ(folded.layout.calls(), count(text, "M98"));
    EXPECT_LT(count(text, "\n"), 130u);
}

TEST(Repeats, CircuitsOfWholeStepsNeedNoCorrection) {
    const Machine machine = six_axis();
    const BlockList planned = pattern(machine, {.circuits = 50, .advance_deg = 1234.5, .lead = 2});
    const FoldedProgram folded = fold_repeats(planned);
    check(machine, planned, folded);
    EXPECT_EQ(folded.layout.subprograms.size(), 1u);
    EXPECT_EQ(folded.layout.calls(), 1u);
    const std::string text = write(machine, folded);
    EXPECT_NE(text.find("F3000\nM98 P1001 L50\n(course 102)\n"), std::string::npos);
    EXPECT_EQ(text.find("\nM2\nO1001\nG1 ") + 1, text.find("M2\nO1001\n"));
    EXPECT_EQ(text.substr(text.size() - 4), "M99\n");
}

TEST(Repeats, ToleranceSaysHowOftenItIsCorrected) {
    const Machine machine = six_axis();
    const BlockList planned = pattern(machine, {.circuits = 100, .advance_deg = 400.0005});
    std::size_t before = planned.blocks.size();
    for (const double tolerance_deg : {0.0, 0.002, 0.01, 0.06}) {
        const FoldedProgram folded = fold_repeats(planned, {.rotary_deg = tolerance_deg});
        ASSERT_FALSE(folded.layout.main.empty());
        EXPECT_LE(folded.layout.drift_nano[0],
                  std::max<std::int64_t>(1'000'000, std::llround(tolerance_deg * 1e9)));
        EXPECT_LT(folded.layout.calls(), before);
        before = folded.layout.calls();
    }
    EXPECT_EQ(before, 1u);
}

TEST(Repeats, CoarseAxesAreHeldToAStep) {
    Machine machine = six_axis();
    machine.mandrel_chain[0].resolution_nano = 15'625'000;  // 1/64 deg
    const BlockList planned = pattern(machine, {.circuits = 60, .advance_deg = 777.773});
    const FoldedProgram folded = fold_repeats(planned);
    EXPECT_FALSE(folded.layout.main.empty());
    check(machine, planned, folded);
}

// No block behind the circuits leads back to the plan, so the last circuit must.
TEST(Repeats, EndOfTheProgramIsExact) {
    const Machine machine = six_axis();
    for (const double advance_deg : {1234.56746, 400.0005, 777.773, 360.0 * std::sqrt(2.0)}) {
        for (const std::int64_t step : {1'000'000, 15'625'000}) {
            Machine coarse = machine;
            coarse.mandrel_chain[0].resolution_nano = step;
            const BlockList planned =
                pattern(coarse, {.circuits = 100, .advance_deg = advance_deg, .lead = 0});
            const FoldedProgram folded = fold_repeats(planned);
            ASSERT_FALSE(folded.layout.main.empty());
            EXPECT_GT(folded.layout.drift_nano[0], 0);
            check(coarse, planned, folded);
            const std::size_t end = planned.blocks.size() - 1;
            for (std::size_t a = 0; a < planned.axes.size(); ++a) {
                EXPECT_EQ(folded.list.row(end)[a], planned.row(end)[a]) << advance_deg;
            }
        }
    }
}

// The second run begins where the first one has led, which is not quite where it is planned.
TEST(Repeats, RunsNextToOneAnother) {
    const Machine machine = six_axis();
    for (int i = 0; i < 20; ++i) {
        BlockList planned =
            pattern(machine, {.circuits = 50, .advance_deg = 400.0001 + 0.0007 * i, .lead = 0});
        const BlockList second =
            pattern(machine, {.circuits = 60, .length = 20, .advance_deg = 500.0004, .lead = 0});
        const std::size_t end = planned.blocks.size() - 1;
        for (std::size_t b = 1; b < second.blocks.size(); ++b) {
            planned.blocks.push_back(second.blocks[b]);
            for (std::size_t a = 0; a < planned.axes.size(); ++a) {
                planned.nano.push_back(planned.row(end)[a] + second.row(b)[a] - second.row(0)[a]);
            }
        }
        const FoldedProgram folded = fold_repeats(planned);
        ASSERT_FALSE(folded.layout.main.empty());
        check(machine, planned, folded);
        EXPECT_EQ(folded.list.nano.back(), planned.nano.back());
    }
}

// Count, length, advance and lead at random, two patterns one after the other.
TEST(Repeats, RandomPatterns) {
    const Machine machine = six_axis();
    std::mt19937 engine(1);
    for (int i = 0; i < 60; ++i) {
        SCOPED_TRACE(i);
        const auto number = [&](int least, int most) {
            return std::uniform_int_distribution<int>(least, most)(engine);
        };
        const auto any = [&] {
            return pattern(machine, {.circuits = number(1, 120),
                                     .length = 2 * number(2, 40),
                                     .advance_deg = 1e-4 * number(1, 20'000'000),
                                     .lead = number(1, 30)});
        };
        BlockList planned = any();
        const BlockList second = any();
        const std::size_t end = planned.blocks.size() - 1;
        for (std::size_t b = 1; b < second.blocks.size(); ++b) {
            planned.blocks.push_back(second.blocks[b]);
            for (std::size_t a = 0; a < planned.axes.size(); ++a) {
                planned.nano.push_back(planned.row(end)[a] + second.row(b)[a] - second.row(0)[a]);
            }
        }
        const FoldedProgram folded = fold_repeats(planned);
        if (folded.layout.main.empty()) {
            EXPECT_EQ(folded.list.nano, planned.nano);
            continue;
        }
        check(machine, planned, folded);
        EXPECT_EQ(fold_repeats(planned).layout.main, folded.layout.main);
    }
}

TEST(Repeats, OtherProgramsAreWrittenAsTheyAre) {
    const Machine machine = six_axis();
    std::vector<BlockList> lists = {LinuxCnc().prepare(test::random_list(machine, 1, 2000)),
                                    empty_list(machine), pattern(machine, {.circuits = 2}),
                                    pattern(machine, {.circuits = 3, .lead = 100})};
    add(lists[1], {0, 0, 0, 0, 0, 0}, 0.0);
    BlockList helix = lists[1];  // blocks that are all equal are no circuit: nothing comes back
    BlockList dwell = lists[1];  // nor is a turn of the mandrel alone
    for (int i = 1; i <= 5000; ++i) {
        add(helix, {360 * i, 4 * i, 0, 0, 0, 0}, 0.01);
        add(dwell, {360 * i, 0, 0, 0, 0, 0}, 0.01);
    }
    lists.push_back(helix);
    lists.push_back(dwell);
    lists.push_back(pattern(machine, {.circuits = 30}));
    for (std::size_t i = 1; i < lists.back().blocks.size(); ++i) {
        lists.back().blocks[i].duration_s *= 1.0 + 1e-5 * static_cast<double>(i);
    }
    for (std::size_t i = 0; i < lists.size(); ++i) {
        const FoldedProgram folded = fold_repeats(lists[i]);
        EXPECT_TRUE(folded.layout.main.empty()) << i;
        EXPECT_EQ(folded.layout.calls(), 0u);
        EXPECT_EQ(folded.list.nano, lists[i].nano);
        EXPECT_EQ(write(machine, folded), LinuxCnc().write(machine, lists[i], {.version = "test"}));
    }
}

// Three axes move by a step once each in three circuits; their mean moves none.
TEST(Repeats, NoBlockLosesItsMotion) {
    const Machine machine = six_axis();
    BlockList list = empty_list(machine);
    std::vector<std::int64_t> at(6, 0);
    add(list, at, 0.0);
    for (std::size_t circuit = 0; circuit < 3; ++circuit) {
        const std::size_t axis = std::vector<std::size_t>{0, 4, 5}[circuit];
        for (int i = 0; i < 20; ++i) {
            at[1] += i < 10 ? 500 : -500;
            add(list, at, 0.1);
        }
        ++at[axis];
        add(list, at, 0.1);
    }
    EXPECT_TRUE(fold_repeats(list).layout.main.empty());
}

// A tiny linear move that a correction would make turn: the interpreter would run it too fast.
TEST(Repeats, CorrectionsMakeNoBlockThatMustBeSplit) {
    const Machine machine = six_axis();
    BlockList list = empty_list(machine);
    std::vector<std::int64_t> at(6, 0);
    add(list, at, 0.0);
    for (int circuit = 0; circuit < 100; ++circuit) {
        at[1] += 1;
        add(list, at, 30.0);
        for (int i = 0; i < 40; ++i) {
            at[0] = static_cast<std::int64_t>(1000.4 * circuit + 25.01 * (i + 1));
            at[1] += i < 20 ? 500 : i < 39 ? -500 : -501;
            add(list, at, 0.1);
        }
    }
    const LinuxCnc dialect;
    EXPECT_EQ(dialect.prepare(list).nano, list.nano);
    EXPECT_FALSE(fold_repeats(list).layout.main.empty());
    EXPECT_TRUE(dialect.fold(list).layout.main.empty());
    EXPECT_EQ(dialect.fold(list).list.nano, list.nano);
}

}  // namespace
}  // namespace meshwind
