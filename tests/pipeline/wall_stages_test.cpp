// What a wall asks for, where, and what lies there, on a pipe.
#include "pipeline/wall/wall_stages.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "pipeline/plan_layer.h"
#include "tests/support/any_machine.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

using test::kPipeLength_mm;
using test::kPipeRadius_mm;
using test::Refused;

// Of some 600 places at a quarter of the tow's width, shares are known to this.
constexpr double kSampled = 0.02;

const Mandrel& pipe() {
    static const Mandrel kPipe = test::small_pipe();
    return kPipe;
}

Job wall_job(const WallJob& wall) {
    Job job = test::pipe_job(LayerKind::Wall);
    job.layers.front().wall = wall;
    return job;
}

WallPart part(double layers) {
    WallPart part;
    part.amount.layers = layers;
    return part;
}

WallStages stages_of(const WallJob& wall) {
    return {pipe(), wall_job(wall), 0, 1, "job.json"};
}

double mean_of(const std::vector<std::int32_t>& numbers) {
    double sum = 0.0;
    for (const std::int32_t number : numbers) {
        sum += number;
    }
    return sum / static_cast<double>(numbers.size());
}

// Stages lay 4 % of the radius of 30 mm at most: 1.2 mm, four layers of 0.25 mm.
TEST(WallStages, ShareTheLayersAmongStages) {
    const WallStages stages = stages_of({.amount = {.layers = 10.0}});
    ASSERT_FALSE(stages.done());
    const StageAsk ask = stages.next();
    EXPECT_EQ(ask.stages_left, 3);
    EXPECT_EQ(ask.everywhere, 4.0);  // 10 / 3, rounded up
    EXPECT_EQ(mean_of(ask.measured.layers), 4.0);
    EXPECT_EQ(mean_of(ask.left), 10.0);
    EXPECT_EQ(ask.beyond_layers, 0.0);
    EXPECT_NE(ask.measured.at.size(), 0U);
    EXPECT_EQ(ask.weighed.at.size(), ask.weighed.layers.size());
}

TEST(WallStages, CountAThicknessInWholeLayers) {
    // 1.1 mm are 4.4 layers of 0.25 mm; 1 mm is four.
    EXPECT_EQ(stages_of({.amount = {.thickness_mm = 1.1}}).figures().asked_layers, 5.0);
    EXPECT_NEAR(stages_of({.amount = {.thickness_mm = 1.0}}).figures().asked_layers, 4.0, 1e-9);
}

// Shares of a cylinder are those of its height.
TEST(WallStages, AskForMoreInAPart) {
    WallJob wall{.amount = {.layers = 2.0}};
    WallPart upper = part(4.0);
    upper.box = {{-100.0, -100.0, 0.0}, {100.0, 100.0, 100.0}};
    wall.parts = {upper};
    EXPECT_NEAR(stages_of(wall).figures().asked_layers, 3.0, 2.0 * kSampled);
    WallPart rim = part(6.0);
    rim.rim = 0;
    rim.within_mm = 24.0;  // a fifth of the length
    wall.parts = {rim};
    EXPECT_NEAR(stages_of(wall).figures().asked_layers, 2.0 + 4.0 * 0.2, 4.0 * kSampled);
    WallPart all = part(3.0);
    all.region = pipe().surface.region.front();
    wall.parts = {rim, all};  // the last one counts
    EXPECT_EQ(stages_of(wall).figures().asked_layers, 3.0);
    // A ball of 40 mm about a point of the wall holds what is within 40 mm along its ruling, and
    // less beside it: less than the rectangle of 80 mm by the arc of a chord of 40 mm to either
    // side, more than the disc of 40 mm flat.
    WallPart ball = part(3.0);
    ball.point = Eigen::Vector3d(kPipeRadius_mm, 0.0, 0.0);
    ball.within_mm = 40.0;
    wall.parts = {ball};
    const double share = stages_of(wall).figures().asked_layers - 2.0;
    const double wall_mm2 = 2.0 * kPi * kPipeRadius_mm * kPipeLength_mm;
    const double arc_mm = 4.0 * kPipeRadius_mm * std::asin(20.0 / kPipeRadius_mm);
    EXPECT_LT(share, 80.0 * arc_mm / wall_mm2);
    EXPECT_GT(share, kPi * 1600.0 / wall_mm2 - kSampled);
}

// A pattern of two covers lies four times everywhere, five where bands overlap.
TEST(WallStages, CountWhatAPatternLays) {
    const WallJob wall{.amount = {.layers = 4.0}};
    const meshwind::Setup setup =
        make_setup(test::small_pipe(), test::shipped("six_axis"), wall_job(wall));
    WallStages stages = stages_of(wall);
    const StageAsk ask = stages.next();
    EXPECT_EQ(ask.stages_left, 1);
    LayerPlanOptions options;
    options.stage = &ask;
    LayerJob layer = setup.job.layers.front();
    layer.angle_deg = test::kPipeAngle_deg;
    const Plan plan = plan_layer(setup, layer, test::AnyMachine(), options).plan;
    ASSERT_EQ(plan.failure, "");
    ASSERT_NE(plan.pattern(), nullptr);
    stages.enter(setup.mandrel.surface, plan);
    EXPECT_TRUE(stages.done());
    const WallFigures figures = stages.figures();
    EXPECT_EQ(figures.stages, 1);
    EXPECT_LE(figures.below_share, kMaxBelow);
    EXPECT_GE(figures.mean_ratio, 1.0);
    // Circuits are a whole number, which may be a quarter more.
    EXPECT_LE(figures.mean_ratio, 1.25);
    EXPECT_NEAR(figures.fibre_mm, plan.fibre_length_mm, 1e-9);
    EXPECT_TRUE(wall_check(figures, kMaxBelow).ok);
    EXPECT_EQ(wall_check(figures, 0.0).ok, figures.below_share == 0.0);
}

TEST(WallStages, SayWhatLacks) {
    WallStages stages = stages_of({.amount = {.layers = 8.0}});
    Plan nothing;
    nothing.reached.assign(stages.next().measured.at.size(), 1);
    stages.enter(pipe().surface, nothing);
    EXPECT_FALSE(stages.done());
    EXPECT_EQ(stages.next().everywhere, 8.0);  // of this stage, with what the first left
    const WallFigures figures = stages.figures();
    EXPECT_EQ(figures.reachable, 1.0);
    EXPECT_EQ(figures.below_share, 1.0);
    EXPECT_EQ(figures.mean_ratio, 0.0);
    ASSERT_EQ(figures.thin.size(), 1U);
    EXPECT_NEAR(figures.thin.front().most_lacking_mm, 8 * 0.25, 1e-12);
    const Check check = wall_check(figures, kMaxBelow);
    EXPECT_FALSE(check.ok);
    EXPECT_EQ(check.numbers.at("below"), 1.0);
    EXPECT_EQ(check.numbers.at("limit"), kMaxBelow);
    ASSERT_TRUE(check.place.has_value());
    EXPECT_NEAR(check.place->position_mm.head<2>().norm(), kPipeRadius_mm, 0.2);
}

// A place that courses no longer pass once the wall has grown is none that a wall can have there.
TEST(WallStages, CountAsReachedWhatEachStageReaches) {
    WallStages stages = stages_of({.amount = {.layers = 8.0}});
    const std::size_t places = stages.next().measured.at.size();
    Plan plan;
    plan.reached.assign(places, 1);
    stages.enter(pipe().surface, plan);
    std::fill_n(plan.reached.begin(), places / 2, 0);
    EXPECT_EQ(mean_of(stages.next().left), 8.0);
    stages.enter(pipe().surface, plan);
    EXPECT_NEAR(stages.figures().reachable, 0.5, 0.05);
    EXPECT_NEAR(mean_of(stages.next().left), 4.0, 1e-9);  // nothing is asked for elsewhere
    EXPECT_TRUE(stages.laid());
    EXPECT_TRUE(stages.done());  // the last one brought nothing
}

// But where the fibres join hardly anything of what is in reach.
TEST(WallStages, CountAsReachedWhatTheFibresJoin) {
    for (const auto& [joined, expected] : {std::pair(0.95, 0.95), {0.5, 1.0}}) {
        WallStages stages = stages_of({.amount = {.layers = 8.0}});
        const std::size_t places = stages.next().measured.at.size();
        Plan plan;
        plan.reached.assign(places, 1);
        plan.joinable.assign(places, 0);
        std::fill_n(plan.joinable.begin(), static_cast<std::size_t>(joined * double(places)), 1);
        stages.enter(pipe().surface, plan);
        EXPECT_NEAR(stages.figures().reachable, expected, 0.02);
    }
}

TEST(WallStages, RefuseWhatIsNotThere) {
    const auto refusal = [](const WallJob& wall) {
        return test::refusal_of([&] { require_wall(pipe(), wall_job(wall), 0, "job.json"); });
    };
    EXPECT_EQ(refusal({.amount = {.thickness_mm = 0.2}}),
              (Refused{"job.wall_thin", "job.json: /layers/0"}));
    WallJob wall{.amount = {.layers = 2.0}};
    WallPart there = part(4.0);
    there.region = 99;
    wall.parts = {part(3.0), there};
    wall.parts.front().region = pipe().surface.region.front();
    EXPECT_EQ(refusal(wall), (Refused{"job.no_region", "job.json: /layers/0/parts/1/region"}));
    there.region.reset();
    there.rim = 7;
    there.within_mm = 5.0;
    wall.parts = {there};
    EXPECT_EQ(refusal(wall), (Refused{"job.no_rim", "job.json: /layers/0/parts/0/rim"}));
    there.rim.reset();
    there.point = Eigen::Vector3d::Zero();
    wall.parts = {there};
    EXPECT_EQ(refusal(wall), (Refused{"job.wall_place", "job.json: /layers/0/parts/0"}));
}

}  // namespace
}  // namespace meshwind
