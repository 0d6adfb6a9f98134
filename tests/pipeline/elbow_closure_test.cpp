// The check "closure" on programs of an elbow that are wound again: as planned, and altered by
// single steps.
#include <cmath>
#include <span>

#include <gtest/gtest.h>

#include "pipeline/load_inputs.h"
#include "pipeline/pattern_checks.h"
#include "pipeline/piece_program.h"
#include "pipeline/plan_layer.h"
#include "pipeline/setup.h"
#include "postproc/verify/laydown.h"
#include "tests/support/any_machine.h"
#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

class ElbowClosure : public testing::Test {
protected:
    void SetUp() override {
        setup_ = make_setup(test::made("elbow",
                                       {{"pipe-radius", 40.0},
                                        {"bend-radius", 120.0},
                                        {"angle", 0.5 * kPi},
                                        {"leg1", 150.0},
                                        {"leg2", 150.0}},
                                       6.0),
                            load_machine(MESHWIND_SOURCE_DIR "/machines/six_axis.json"), Job{});
        LayerJob layer;
        layer.kind = LayerKind::Helical;
        layer.angle_deg = 78.0;
        plan_ = plan_layer(setup_, layer, test::AnyMachine()).plan;
        ASSERT_EQ(plan_.failure, "");
        made_ = program_of(setup_, plan_.pieces);
        ASSERT_TRUE(made_.refused.empty());
        meant_ = lay_down(*setup_.wall, setup_.machine, made_.exact, *made_.exact.tie_on_mm);
        ASSERT_EQ(meant_.failure, "");
    }

    // The check on the program with its spindle turned by so many steps more per circuit.
    [[nodiscard]] Check closure(std::int64_t steps) const {
        BlockList list = made_.read;
        std::size_t spindle = 0;
        while (list.axes[spindle].letter != 'C') {
            ++spindle;
        }
        for (std::size_t b = 0; b < list.blocks.size(); ++b) {
            // Two passes and two turns are a circuit.
            const std::int64_t circuit = std::max(0, list.blocks[b].piece) / 4;
            list.nano[b * list.axes.size() + spindle] +=
                steps * circuit * list.axes[spindle].resolution_nano;
        }
        const LaidPath laid = lay_down(*setup_.wall, setup_.machine, list, *list.tie_on_mm);
        EXPECT_EQ(laid.failure, "");
        return elbow_closure_check(plan_, setup_.job.tow.width_mm, laid.path, meant_.path);
    }

    meshwind::Setup setup_;
    Plan plan_;
    PieceProgram made_;
    LaidPath meant_;
};

// A leg turns by as much as the spindle does, seen along its axis. The spindle is not that axis,
// so places around it move by unlike amounts; the resolution says by how unlike.
TEST_F(ElbowClosure, OneStepPerCircuitFails) {
    const auto circuits = static_cast<double>(plan_.elbow()->lines);
    ASSERT_GT(circuits, 20.0);  // of 0.001 deg each
    const Check planned = closure(0);
    EXPECT_TRUE(planned.ok) << planned.words;
    // Rounding is of sums, so nothing adds up.
    EXPECT_LT(planned.numbers.at("closure_deg"), 0.001);
    EXPECT_LT(planned.numbers.at("resolution_deg"), 0.001);
    const double leg = std::abs(plan_.elbow()->line->at(0.0).tangent.z());
    for (const std::int64_t steps : {1, -1}) {
        const Check altered = closure(steps);
        EXPECT_FALSE(altered.ok);
        EXPECT_NEAR(altered.numbers.at("closure_deg"), 0.001 * circuits * leg,
                    altered.numbers.at("resolution_deg"));
        EXPECT_NE(altered.words, "");
    }
}

}  // namespace
}  // namespace meshwind
