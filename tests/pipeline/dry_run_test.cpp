// A program in the air: the blocks are those of the program, and nothing comes near the part.
#include "pipeline/resume/dry_run.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "machines/kinematics.h"
#include "pipeline/wind.h"
#include "tests/support/run_checks.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

constexpr double kClear_mm = 180.0;

struct Wound {
    Machine machine;
    Job job;
    std::string file, text;

    [[nodiscard]] DryRun in_the_air(double clearance_mm) const {
        return dry_run(make_setup(test::small_pipe(), machine, job), {.program = {file, text}},
                       clearance_mm);
    }

    [[nodiscard]] BlockList blocks() const {
        auto setup = make_setup(test::small_pipe(), machine, job);
        return read_program(setup, {.program = {file, text}});
    }
};

Wound wound(const std::string& name, Job job = test::quick_job()) {
    const Machine machine = test::shipped(name);
    const meshwind::Run run = wind(test::small_pipe(), machine, job);
    EXPECT_EQ(test::failed_checks(run), std::vector<std::string>{});
    const FibreProgram& program = run.layers.front().programs.front();
    return {machine, std::move(job), program.file, program.text};
}

// Of the envelope's capsules from the line of the spindle, in the middle of each block.
double least_distance_mm(const Machine& machine, const BlockList& list) {
    double least_mm = 1e9;
    for (std::size_t block = 1; block < list.blocks.size(); ++block) {
        std::vector<double> q = joints_at(list, block - 1);
        const std::vector<double> end = joints_at(list, block);
        for (std::size_t a = 0; a < q.size(); ++a) {
            q[a] = 0.5 * (q[a] + end[a]);
        }
        for (const EnvelopePart& part : machine.eye.envelope) {
            const auto& capsule = std::get<Capsule>(part.shape);
            for (int i = 0; i <= 20; ++i) {
                const Eigen::Vector3d at_zero =
                    capsule.from_mm + 0.05 * i * (capsule.to_mm - capsule.from_mm);
                const Eigen::Vector3d p = base_from_link(machine, q, part.link) * at_zero;
                least_mm = std::min(least_mm, std::hypot(p.x(), p.y()) - capsule.radius_mm);
            }
        }
    }
    return least_mm;
}

TEST(DryRun, TheSameIncrementsFarFromThePart) {
    for (const std::string name : {"six_axis", "five_axis", "four_axis"}) {
        SCOPED_TRACE(name);
        const Wound program = wound(name);
        const DryRun run = program.in_the_air(kClear_mm);
        const BlockList whole = program.blocks();
        ASSERT_EQ(run.blocks.moves(), whole.moves());
        for (std::size_t block = 0; block < whole.blocks.size(); ++block) {
            EXPECT_EQ(run.blocks.blocks[block].duration_s, whole.blocks[block].duration_s);
            for (std::size_t a = 0; a < whole.axes.size(); ++a) {
                const double by_mm = whole.axes[a].letter == run.axis ? run.moved_mm : 0.0;
                EXPECT_NEAR(run.blocks.value(block, a), whole.value(block, a) + by_mm, 1e-9);
            }
        }
        EXPECT_LT(least_distance_mm(program.machine, whole), test::kPipeRadius_mm + kClear_mm);
        EXPECT_GE(least_distance_mm(program.machine, run.blocks),
                  test::kPipeRadius_mm + kClear_mm - 0.2);  // the pipe has flat facets
        EXPECT_EQ(run.axis, 'X');
        EXPECT_FALSE(run.blocks.tie_on_mm);
        EXPECT_NE(run.text.find("no fibre"), std::string::npos);
        EXPECT_EQ(run.text.find("tie the fibre"), std::string::npos);
    }
}

TEST(DryRun, RefusesWhatTheMachineCannotDo) {
    const Wound six = wound("six_axis");
    EXPECT_EQ(test::refusal_of([&] { (void)six.in_the_air(5000.0); }).code, "dry_run.no_room");
    const Wound hobby = wound("hobby_grbl");
    EXPECT_EQ(test::refusal_of([&] { (void)hobby.in_the_air(20.0); }).code, "dry_run.no_axis");
}

}  // namespace
}  // namespace meshwind
