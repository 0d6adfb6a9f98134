// The check "closure" on programs of an elbow that are wound again: as planned, and altered by
// single steps.
#include <cmath>
#include <filesystem>
#include <span>

#include <gtest/gtest.h>

#include "cli/make_command.h"
#include "cli/pattern_checks.h"
#include "cli/piece_program.h"
#include "cli/plan_layer.h"
#include "cli/setup.h"
#include "postproc/laydown.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

class ElbowClosure : public testing::Test {
protected:
    void SetUp() override {
        const fs::path mesh = fs::path(testing::TempDir()) / "elbow_closure.stl";
        (void)run_make({.kind = "elbow",
                        .shown_values = {{"pipe-radius", 40.0},
                                         {"bend-radius", 120.0},
                                         {"angle", 90.0},
                                         {"leg1", 150.0},
                                         {"leg2", 150.0}},
                        .options = {.edge_mm = 6.0},
                        .output = mesh});
        setup_ = read_setup(
            {mesh, fs::path(MESHWIND_SOURCE_DIR) / "machines" / "six_axis.json", {}, 0.0});
        fs::remove(mesh);
        LayerJob layer;
        layer.kind = LayerKind::Helical;
        layer.angle_deg = 78.0;
        LayerPlanOptions options;
        options.refused = [](std::span<const Piece>) { return std::vector<std::size_t>{}; };
        plan_ = plan_layer(setup_, layer, options);
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
    const auto circuits = static_cast<double>(plan_.elbow->lines);
    ASSERT_GT(circuits, 20.0);  // of 0.001 deg each
    const Check planned = closure(0);
    EXPECT_TRUE(planned.ok) << planned.words;
    // Rounding is of sums, so nothing adds up.
    EXPECT_LT(planned.numbers.at("closure_deg"), 0.001);
    EXPECT_LT(planned.numbers.at("resolution_deg"), 0.001);
    const double leg = std::abs(plan_.elbow->line->at(0.0).tangent.z());
    for (const std::int64_t steps : {1, -1}) {
        const Check altered = closure(steps);
        EXPECT_FALSE(altered.ok);
        EXPECT_NEAR(altered.numbers.at("closure_deg"), 0.001 * circuits * leg,
                    altered.numbers.at("resolution_deg"));
        EXPECT_NE(altered.words.find("does not close"), std::string::npos) << altered.words;
    }
}

}  // namespace
}  // namespace meshwind
