// The check "closure" on programs that are wound again: as planned, and altered by single steps.
#include <filesystem>
#include <span>

#include <gtest/gtest.h>

#include "cli/make_command.h"
#include "cli/pattern_checks.h"
#include "cli/piece_program.h"
#include "cli/plan_layer.h"
#include "cli/setup.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

class PatternClosure : public testing::Test {
protected:
    void SetUp() override {
        const fs::path mesh = fs::path(testing::TempDir()) / "pattern_closure.stl";
        (void)run_make({.kind = "cylinder",
                        .shown_values = {{"radius", 40.0}, {"length", 200.0}},
                        .options = {.edge_mm = 6.0},
                        .output = mesh});
        setup_ = read_setup(
            {mesh, fs::path(MESHWIND_SOURCE_DIR) / "machines" / "six_axis.json", {}, 0.0});
        fs::remove(mesh);
        LayerJob layer;
        layer.kind = LayerKind::Helical;
        layer.angle_deg = 50.0;
        LayerPlanOptions options;
        options.refused = [](std::span<const Piece>) { return std::vector<std::size_t>{}; };
        plan_ = plan_layer(setup_, layer, options);
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
    const auto circuits = static_cast<double>(plan_.pattern->starts_rad.size());
    ASSERT_GT(circuits, 20.0);  // of 0.001 deg each
    const Check planned = closure(0);
    EXPECT_TRUE(planned.ok) << planned.words;
    // Rounding is of sums, so nothing adds up.
    EXPECT_LT(planned.numbers.at("closure_deg"), 0.001);
    for (const std::int64_t steps : {1, -1}) {
        const Check altered = closure(steps);
        EXPECT_FALSE(altered.ok);
        EXPECT_NEAR(altered.numbers.at("closure_deg"), 0.001 * circuits, 0.002);
        EXPECT_NE(altered.words.find("does not close"), std::string::npos) << altered.words;
    }
}

}  // namespace
}  // namespace meshwind
