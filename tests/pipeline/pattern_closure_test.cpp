// The check "closure" on programs that are wound again: as planned, and altered by single steps.
#include <span>

#include <gtest/gtest.h>

#include "pipeline/load_inputs.h"
#include "pipeline/pattern_checks.h"
#include "pipeline/piece_program.h"
#include "pipeline/plan_layer.h"
#include "pipeline/setup.h"
#include "tests/support/any_machine.h"
#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

class PatternClosure : public testing::Test {
protected:
    void SetUp() override {
        setup_ = make_setup(test::made_cylinder(40.0, 200.0, 6.0),
                            load_machine(MESHWIND_SOURCE_DIR "/machines/six_axis.json"), Job{});
        LayerJob layer;
        layer.kind = LayerKind::Helical;
        layer.angle_deg = 50.0;
        plan_ = plan_layer(setup_, layer, test::AnyMachine()).plan;
        ASSERT_EQ(plan_.failure, "");
        made_ = program_of(setup_, plan_.pieces);
        ASSERT_TRUE(made_.refused.empty());
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
        const Verification wound = verify_program(setup_, list, {});
        EXPECT_EQ(wound.laid.failure, "");
        return closure_check(plan_, wound.laid.path);
    }

    meshwind::Setup setup_;
    Plan plan_;
    PieceProgram made_;
};

TEST_F(PatternClosure, OneStepPerCircuitFails) {
    ASSERT_EQ(setup_.machine.mandrel_chain.front().letter, 'C');
    const auto circuits = static_cast<double>(plan_.pattern()->starts_rad.size());
    ASSERT_GT(circuits, 20.0);  // of 0.001 deg each
    const Check planned = closure(0);
    EXPECT_TRUE(planned.ok) << planned.words;
    // Rounding is of sums, so nothing adds up.
    EXPECT_LT(planned.numbers.at("closure_deg"), 0.001);
    for (const std::int64_t steps : {1, -1}) {
        const Check altered = closure(steps);
        EXPECT_FALSE(altered.ok);
        EXPECT_NEAR(altered.numbers.at("closure_deg"), 0.001 * circuits, 0.002);
        EXPECT_NE(altered.words, "");
    }
}

}  // namespace
}  // namespace meshwind
