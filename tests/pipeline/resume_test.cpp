// A program that stopped, from random blocks on: what is left lays what the whole lays there.
#include "pipeline/resume/resume.h"

#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"
#include "pipeline/wind.h"
#include "tests/support/run_checks.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

// A program of the small pipe, wound.
LaidProgram laid(const std::string& machine, const Job& job) {
    const Machine of = test::shipped(machine);
    meshwind::Run run = wind(test::small_pipe(), of, job);
    EXPECT_EQ(test::failed_checks(run), std::vector<std::string>{});
    const FibreProgram& program = run.layers.front().programs.front();
    return lay_program(make_setup(test::small_pipe(), of, job),
                       {.program = {program.file, program.text}});
}

std::string resume_error(const LaidProgram& program, std::size_t block) {
    try {
        (void)resume(program, block);
    } catch (const InputError& error) {
        return error.code();
    }
    return "resumed";
}

class ResumeOn : public testing::TestWithParam<const char*> {};

TEST_P(ResumeOn, FromAnyBlockOnTheRestLaysWhatTheWholeDoes) {
    constexpr int kBlocks = 25;
    // The tie-on has three decimals, F six digits.
    constexpr double kSame_mm = 2e-3;
    const LaidProgram whole = laid(GetParam(), test::pipe_job());
    std::mt19937 engine(26);
    std::uniform_int_distribution<std::size_t> any(1, whole.blocks.moves() - 1);
    for (int i = 0; i < kBlocks; ++i) {
        const std::size_t block = any(engine);
        SCOPED_TRACE(block);
        const ResumedProgram rest = resume(whole, block);
        for (const Check& check : rest.verification.checks) {
            EXPECT_TRUE(check.ok) << check.name << ": " << check.words;
        }
        ASSERT_TRUE(rest.verification.deviation.has_value());
        EXPECT_LT(rest.verification.deviation->max_mm, kSame_mm);
        EXPECT_LT(rest.verification.deviation->end_gap_mm, kSame_mm);
        EXPECT_NEAR(rest.laid_mm + rest.verification.fibre_length_mm, whole.laid.path.back().s_mm,
                    0.01);
        ASSERT_GE(rest.blocks.moves(), whole.blocks.moves() - block);
        // Where every axis is, but for whole turns; no spindle begins many of them away.
        for (std::size_t a = 0; a < rest.blocks.axes.size(); ++a) {
            const double turns = (rest.blocks.value(0, a) - whole.blocks.value(block, a)) / 360.0;
            EXPECT_NEAR(turns, std::round(turns), 1e-6);
            EXPECT_LT(std::abs(rest.blocks.value(0, a)), 720.0);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Machines, ResumeOn,
                         testing::Values("six_axis", "four_axis", "hobby_grbl", "two_axis",
                                         "robot_winder"));

TEST(Resume, RefusesBlocksThatLeaveNothing) {
    const LaidProgram whole = laid("six_axis", test::quick_job());
    EXPECT_EQ(resume_error(whole, 0), "resume.block");
    EXPECT_EQ(resume_error(whole, whole.blocks.moves()), "resume.block");
    EXPECT_EQ(resume_error(whole, whole.blocks.moves() - 1), "resumed");
}

TEST(Resume, RefusesBlocksThatEndOnAPin) {
    Job job = test::quick_job();
    job.mandrel.turn = TurnKind::Pins;
    const LaidProgram whole = laid("six_axis", job);
    ASSERT_FALSE(whole.blocks.pins.empty());
    int on_pins = 0;
    for (std::size_t block = 1; block < whole.blocks.moves(); block += 7) {
        try {
            const ResumedProgram rest = resume(whole, block);
            for (const Check& check : rest.verification.checks) {
                EXPECT_TRUE(check.ok) << block << ": " << check.name << ": " << check.words;
            }
        } catch (const InputError& error) {
            EXPECT_EQ(error.code(), "resume.in_the_air");
            ++on_pins;
        }
    }
    EXPECT_GT(on_pins, 0);
}

TEST(Resume, LinesThatAreRunOftenAreNoPlace) {
    const LaidProgram whole = laid("six_axis", test::quick_job());
    const auto error_of = [&](std::int32_t line) {
        try {
            (void)block_of_line(whole, line);
        } catch (const InputError& error) {
            return error.code();
        }
        return std::string("found");
    };
    EXPECT_EQ(error_of(1), "resume.line");
    const std::size_t last = whole.blocks.moves();
    int repeated = 0;
    for (std::size_t block = 1; block <= last; ++block) {
        const std::int32_t line = whole.blocks.blocks[block].line;
        if (error_of(line) == "found") {
            EXPECT_EQ(block_of_line(whole, line), block);
        } else {
            ++repeated;
        }
    }
    EXPECT_LT(repeated, static_cast<int>(last));
}

}  // namespace
}  // namespace meshwind
