// The main job on a mandrel's file: which tries it makes, and which of them stands.
#include "pipeline/trials/trials.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/revolution/swept_wall.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/run_checks.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

using test::check_of;
using test::failed_checks;
using test::kPipeTow_mm;
using test::quick_job;
using test::shipped;
using test::small_pipe;

// Of covers: what is asked here does not depend on how long they are improved.
constexpr double kQuick = 0.1;

// A tee, on which no helix can be wound, until the blend is two tow widths wide; from then on a
// pipe.
Run wind_with_blend(const std::optional<double>& blend_mm, std::vector<double>& asked_mm) {
    const auto mandrel = [&](const Job& asked) {
        asked_mm.push_back(asked.mandrel.blend_mm.value());
        return asked_mm.back() < 2.0 * kPipeTow_mm
                   ? build_mandrel(make_mandrel("tee", {}, {.edge_mm = 15.0}), "tee")
                   : small_pipe();
    };
    Job job = quick_job();
    job.mandrel.blend_mm = blend_mm;
    return wind(mandrel, shipped("six_axis"), job);
}

TEST(Trials, TriesWiderBlendsUntilEveryCheckPasses) {
    std::vector<double> asked_mm;
    const auto run = wind_with_blend(std::nullopt, asked_mm);
    EXPECT_EQ(asked_mm, (std::vector<double>{0.0, kPipeTow_mm, 2.0 * kPipeTow_mm}));
    EXPECT_EQ(failed_checks(run), std::vector<std::string>{});
    EXPECT_EQ(run.layers.front().setup.job.mandrel.blend_mm, 2.0 * kPipeTow_mm);
    EXPECT_GE(run.remarks.size(), 3U);
}

TEST(Trials, GoesOnWhereABlendCannotBeMade) {
    const auto mandrel = [](const Job& asked) {
        if (asked.mandrel.blend_mm == kPipeTow_mm) {
            throw InputError("mesh.no_blend", "pipe", "cannot be blended");
        }
        return asked.mandrel.blend_mm == 0.0
                   ? build_mandrel(make_mandrel("tee", {}, {.edge_mm = 15.0}), "tee")
                   : small_pipe();
    };
    Job job = quick_job();
    job.mandrel.blend_mm.reset();
    const auto run = wind(mandrel, shipped("six_axis"), job);
    EXPECT_EQ(failed_checks(run), std::vector<std::string>{});
    EXPECT_EQ(run.layers.front().setup.job.mandrel.blend_mm, 2.0 * kPipeTow_mm);
}

// A ball with two necks: no fibre crosses their sharp corners, and a hand would fill those up.
TEST(Trials, WindsNecksInAPatternOverABlend) {
    constexpr double kBall_mm = 30.0;
    constexpr double kNeck_mm = 14.0;
    constexpr int kSteps = 24;
    const double last = std::acos(kNeck_mm / kBall_mm);
    std::vector<MeridianNode> nodes{{.radius_mm = kNeck_mm, .z_mm = -60.0, .straight = true}};
    for (int i = -kSteps; i <= kSteps; ++i) {
        const double angle = last * i / kSteps;
        nodes.push_back(
            {.radius_mm = kBall_mm * std::cos(angle), .z_mm = kBall_mm * std::sin(angle)});
        if (std::abs(i) == kSteps) {
            nodes.back().crease = true;
            nodes.back().slope_rad = i < 0 ? -angle : 0.0;
            nodes.back().slope_before_rad = i < 0 ? 0.0 : -angle;
            nodes.back().straight = i > 0;
        }
    }
    nodes.push_back({.radius_mm = kNeck_mm, .z_mm = 60.0});
    const TriangleSoup ball = swept_wall(Meridian(nodes), 100.0).soup;
    const auto mandrel = [&](const Job& asked) {
        return build_mandrel(ball, "ball", mandrel_options(asked));
    };
    Job job = quick_job(LayerKind::Auto);
    job.mandrel.blend_mm.reset();
    const meshwind::Run run = wind(mandrel, shipped("six_axis"), job);
    EXPECT_EQ(failed_checks(run), std::vector<std::string>{});
    const WoundLayer& layer = run.layers.front();
    EXPECT_EQ(layer.plan.planner, Planner::Pattern);
    EXPECT_GT(layer.plan.coverage.fraction, 0.99);
    EXPECT_LT(layer.plan.coverage.max_layers, 20);
    EXPECT_GT(layer.setup.job.mandrel.blend_mm.value(), 0.0);
}

// A cover of a tee with too little friction for its branch; blends cannot be made, but the widest
// give a pipe.
struct BareTee {
    Job job = quick_job(LayerKind::Cover);
    double pipe_from_mm;
    double filled_mm2;  // what its blend is said to fill
    std::vector<double> asked_mm{};

    explicit BareTee(double pipe_from_mm, double filled_mm2 = 1000.0)
        : pipe_from_mm(pipe_from_mm), filled_mm2(filled_mm2) {
        job.tow.friction = 0.05;
        job.mandrel.blend_mm.reset();
        job.mandrel.extension_given = true;
        job.mandrel.turn_given = true;
        job.fibres_given = true;
    }

    [[nodiscard]] meshwind::Run wound(bool force) {
        const auto mandrel = [&](const Job& asked) {
            asked_mm.push_back(asked.mandrel.blend_mm.value());
            if (asked_mm.back() == 0.0) {
                return build_mandrel(make_mandrel("tee", {}, {.edge_mm = 15.0}), "tee");
            }
            if (asked_mm.back() < pipe_from_mm) {
                throw InputError("mesh.no_blend", "tee", "cannot be blended");
            }
            Mandrel pipe = small_pipe();
            pipe.winding_mesh.blended_mm2 = filled_mm2;
            return pipe;
        };
        return wind(mandrel, shipped("six_axis"), job,
                    {.context = {.effort = kQuick}, .force = force});
    }
};

TEST(Trials, LooksAtBlendsBeforeItWindsOne) {
    BareTee tee(3.0 * kPipeTow_mm);
    const meshwind::Run run = tee.wound(false);
    EXPECT_EQ(tee.asked_mm, (std::vector<double>{0.0, kPipeTow_mm, 2.0 * kPipeTow_mm,
                                                 3.0 * kPipeTow_mm, 3.0 * kPipeTow_mm}));
    EXPECT_EQ(failed_checks(run), std::vector<std::string>{});
    EXPECT_EQ(run.layers.front().setup.job.mandrel.blend_mm, 3.0 * kPipeTow_mm);
}

TEST(Trials, PlansOverNoBlendThatFillsNothing) {
    BareTee tee(kPipeTow_mm, 0.9 * kPipeTow_mm * kPipeTow_mm);
    const meshwind::Run run = tee.wound(false);
    EXPECT_EQ(tee.asked_mm, (std::vector<double>{0.0, kPipeTow_mm, 2.0 * kPipeTow_mm,
                                                 3.0 * kPipeTow_mm, 4.0 * kPipeTow_mm}));
    EXPECT_EQ(run.layers.front().setup.job.mandrel.blend_mm, 0.0);
}

// What is too bare is wound by force alone.
TEST(Trials, WindsWhatIsTooBareByForce) {
    for (const bool force : {false, true}) {
        BareTee tee(1000.0);
        const meshwind::Run run = tee.wound(force);
        EXPECT_FALSE(run.passed());
        EXPECT_EQ(run.planned(), force);
        EXPECT_EQ(run.usable, force);
        EXPECT_EQ(tee.asked_mm.size(), force ? 6U : 5U);
    }
}

// Where friction does not do and the job leaves it open, fibre turns on pins, on extensions that
// are as short as those allow.
TEST(Trials, TurnsOnPinsWhereFrictionDoesNotDo) {
    Job job = quick_job(LayerKind::Cover);
    job.tow.friction = 0.1;
    job.mandrel.extension_mm = 30.0;
    job.fibres_given = true;
    std::vector<TurnKind> asked;
    const auto mandrel = [&](const Job& tried) {
        asked.push_back(tried.mandrel.turn);
        return asked.back() == TurnKind::Pins
                   ? small_pipe()
                   : build_mandrel(make_mandrel("tee", {}, {.edge_mm = 15.0}), "tee");
    };
    const auto run = wind(mandrel, shipped("six_axis"), job, {.context = {.effort = kQuick}});
    // Friction once; pins as often as it takes seeds.
    EXPECT_EQ(asked.front(), TurnKind::Friction);
    EXPECT_EQ(std::count(asked.begin(), asked.end(), TurnKind::Friction), 1);
    EXPECT_EQ(failed_checks(run), std::vector<std::string>{});
    const meshwind::Setup& setup = run.layers.front().setup;
    EXPECT_EQ(setup.pins.size(), 2U);
    EXPECT_LT(setup.job.mandrel.extension_mm, 30.0);
}

TEST(Trials, PlansACoverThatFailsAgainWithTheNextSeeds) {
    Job job = quick_job(LayerKind::Cover);
    job.tolerance.laydown_mm = 0.01;
    job.tolerance.laydown_angle_deg = 0.001;  // finer than any program keeps
    job.fibres_given = true;
    job.mandrel.extension_given = true;
    job.mandrel.turn_given = true;
    job.mandrel.blend_mm = 0.0;
    int asked = 0;
    const auto mandrel = [&](const Job&) {
        ++asked;
        return small_pipe();
    };
    const auto run =
        wind(mandrel, shipped("six_axis"), job, {.context = {.seed = 7, .effort = kQuick}});
    EXPECT_EQ(asked, 3);
    EXPECT_FALSE(check_of(run, "laydown").ok);
    EXPECT_NEAR(check_of(run, "coverage").numbers.at("limit"),
                run.layers.front().plan.coverage.reachable - job.tolerance.bare, 1e-12);
    EXPECT_TRUE(std::any_of(run.remarks.begin(), run.remarks.end(), [](const std::string& words) {
        return words.find("seed 9") != std::string::npos;
    }));
}

TEST(Trials, TakesTheBlendThatTheJobHas) {
    std::vector<double> asked_mm;
    EXPECT_FALSE(wind_with_blend(kPipeTow_mm, asked_mm).passed());
    EXPECT_EQ(asked_mm, std::vector<double>{kPipeTow_mm});
}

}  // namespace
}  // namespace meshwind
