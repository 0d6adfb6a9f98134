// The time that a program for GRBL states.
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/wind.h"
#include "postproc/motion/junction_time.h"
#include "tests/support/run_checks.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

const PieceProgram& program_of(const meshwind::Run& run) {
    return run.layers.front().programs.front().made;
}

TEST(GrblTime, IsThatOfItsPlannerAndFinerBlocksTakeLess) {
    Machine machine = test::shipped("hobby_grbl");
    const auto wound = [&](double deviation_mm) {
        machine.controller.junction_deviation_mm = deviation_mm;
        return wind(test::made_cylinder(40.0, 300.0, 6.0), machine, test::pipe_job());
    };
    constexpr double kDefault_mm = 0.01;
    constexpr double kWide_mm = 100.0;
    const meshwind::Run sharp = wound(kDefault_mm);
    EXPECT_EQ(test::failed_checks(sharp), std::vector<std::string>{});
    const PieceProgram& made = program_of(sharp);
    const auto planner_s = [&](const BlockList& list) {
        const std::vector<double> times_s =
            junction_times_s(machine, list, {.deviation_mm = kDefault_mm});
        return std::accumulate(times_s.begin(), times_s.end(), 0.0);
    };
    EXPECT_NEAR(made.duration_s, planner_s(made.read), 1e-9);
    EXPECT_NEAR(made.duration_s, made.read.duration_s() + made.corner_s, 1e-9);
    EXPECT_GT(made.corner_s, 0.0);
    // Who may cut corners widely needs no finer blocks; his would take longer with this setting.
    const meshwind::Run wide = wound(kWide_mm);
    EXPECT_GT(made.blocks.moves(), program_of(wide).blocks.moves());
    EXPECT_LT(made.duration_s, planner_s(program_of(wide).read));
}

}  // namespace
}  // namespace meshwind
