#include "winding/cover/cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/mandrel/thicken.h"
#include "tests/support/cover_plans.h"
#include "tests/support/fixtures.h"
#include "winding/laminate/build_up.h"
#include "winding/laminate/measure_plan.h"

namespace meshwind {
namespace {

constexpr double kExtension_mm = 120.0;

CoverOptions quick_options(const Mandrel& mandrel, int candidates) {
    CoverOptions options;
    options.tow.width_mm = 12.0;
    options.tow.friction = 0.25;
    options.turns.rule.extension_mm = kExtension_mm;
    options.free_fibre.min_mm = 40.0;
    options.free_fibre.start_mm = 2.0 * mandrel.surface.mean_edge_mm;
    options.candidates = candidates;
    options.rounds = 1;
    options.aimed_candidates = candidates / 4;
    options.scarce_candidates = candidates / 4;
    options.context.effort = test::kQuickEffort;
    return options;
}

Plan cover(const Mandrel& mandrel, int candidates, int fibres = 1, double min_free_mm = 40.0,
           const StageAsk* stage = nullptr) {
    CoverOptions options = quick_options(mandrel, candidates);
    options.fibres = fibres;
    options.stage = stage;
    options.free_fibre.min_mm = min_free_mm;
    return plan_cover(mandrel, test::obstacles_of(mandrel, kExtension_mm, test::kTable_mm), options)
        .plan;
}

const Mandrel& tee() {
    static const Mandrel mandrel = test::small_tee(3.5);
    return mandrel;
}

void expect_books_to_balance(const Mandrel& mandrel, const Plan& plan) {
    int courses = 0;
    int fibres = 0;
    double length = 0.0;
    for (const Piece& piece : plan.pieces) {
        courses += piece.kind == PieceKind::Course ? 1 : 0;
        fibres += piece.starts_fibre ? 1 : 0;
        length += piece.path.back().s_mm;
        EXPECT_LE(piece.worst_slip, 0.25);
        EXPECT_LE(piece.worst_slip, plan.worst_slip);
        EXPECT_LE(piece.string.worst_gap_mm, 0.5);
    }
    EXPECT_EQ(courses, plan.courses);
    EXPECT_EQ(fibres, plan.fibres);
    EXPECT_NEAR(length, plan.fibre_length_mm, 1e-6);
    EXPECT_LE(plan.coverage.fraction, plan.coverage.reachable + 1e-12);
    EXPECT_LE(plan.coverage.mean_layers, plan.coverage.max_layers);
    double bare = 0.0;
    for (const Uncovered& u : plan.uncovered) {
        EXPECT_FALSE(u.reason.empty());
        bare += u.area_mm2;
    }
    const double area = test::wall_area_mm2(mandrel.surface);
    EXPECT_NEAR(bare / area, 1.0 - plan.coverage.fraction, 1e-6);
    ASSERT_EQ(plan.face_layers.size(), mandrel.surface.face.size());
}

TEST(PlanCover, CoversACylinderWithOneFibre) {
    const Plan plan = cover(test::wound_cylinder(), 2000);
    ASSERT_EQ(plan.failure, "");
    EXPECT_GT(plan.coverage.fraction, 0.97);
    EXPECT_EQ(plan.fibres, 1);
    test::expect_continuous(plan);
    expect_books_to_balance(test::wound_cylinder(), plan);
}

TEST(PlanCover, CoversASmallTee) {
    const Plan plan = cover(tee(), 4000);
    ASSERT_EQ(plan.failure, "");
    // 0.77 with this small library: a single fibre gives up what it could not come back from.
    EXPECT_EQ(plan.fibres, 1);
    EXPECT_GT(plan.coverage.fraction, 0.7);
    test::expect_continuous(plan);
    expect_books_to_balance(tee(), plan);
}

// Where friction turns few courses round on a short extension, pins turn more; no word of pins
// where they are there already.
TEST(PlanCover, SaysWhatTurnsOnPinsWouldReach) {
    constexpr double kShort_mm = 30.0;
    CoverOptions options = quick_options(tee(), 600);
    options.tow.friction = 0.1;
    options.turns.rule.extension_mm = kShort_mm;
    const RayQuery obstacles = test::obstacles_of(tee(), kShort_mm, test::kTable_mm);
    const auto with_pins = [](const Plan& plan) {
        const auto found = std::find_if(
            plan.what_if.begin(), plan.what_if.end(),
            [](const RelaxedRule& what) { return what.rule == RelaxedRule::Rule::Pins; });
        return found == plan.what_if.end() ? 0.0 : found->reachable;
    };
    const Plan by_friction = plan_cover(tee(), obstacles, options).plan;
    EXPECT_GT(with_pins(by_friction), by_friction.coverage.reachable + 0.05);
    std::string failure;
    options.turns.pins = stand_pins(tee().rims, {}, options.tow, kShort_mm, failure);
    ASSERT_EQ(failure, "");
    const Plan on_pins = plan_cover(tee(), obstacles, options).plan;
    EXPECT_EQ(with_pins(on_pins), 0.0);
    EXPECT_GT(on_pins.coverage.reachable, by_friction.coverage.reachable + 0.05);
}

// With so long a free fibre one that has gone to the branch cannot come back; others may follow it.
constexpr double kLongFree_mm = 120.0;

TEST(PlanCover, CoversMoreOfASmallTeeWithMoreFibres) {
    const Plan one = cover(tee(), 4000, 1, kLongFree_mm);
    const Plan more = cover(tee(), 4000, 4, kLongFree_mm);
    ASSERT_GE(one.reach_of_fibres.size(), 2U);
    EXPECT_EQ(one.reach_of_fibres, more.reach_of_fibres);
    EXPECT_TRUE(std::is_sorted(one.reach_of_fibres.begin(), one.reach_of_fibres.end()));
    EXPECT_GT(more.fibres, 1);
    EXPECT_LE(more.fibres, 4);
    EXPECT_GT(more.coverage.fraction, one.coverage.fraction);
    EXPECT_EQ(fibres_of(more.pieces).size(), static_cast<std::size_t>(more.fibres));
    test::expect_continuous(more);
    expect_books_to_balance(tee(), more);
}

TEST(PlanCover, IsTheSameForAnyNumberOfThreads) {
    const Mandrel tee = test::small_tee(6.0);
    set_thread_count(1);
    const Plan one = cover(tee, 1500);
    set_thread_count(2);
    const Plan two = cover(tee, 1500);
    set_thread_count(0);
    EXPECT_EQ(one.coverage.fraction, two.coverage.fraction);
    ASSERT_EQ(one.pieces.size(), two.pieces.size());
    for (std::size_t i = 0; i < one.pieces.size(); ++i) {
        ASSERT_EQ(one.pieces[i].path.size(), two.pieces[i].path.size());
        for (std::size_t k = 0; k < one.pieces[i].path.size(); ++k) {
            ASSERT_EQ(one.pieces[i].path[k].position_mm, two.pieces[i].path[k].position_mm);
        }
    }
    EXPECT_EQ(one.face_layers, two.face_layers);
    EXPECT_EQ(one.effort.refusals, two.effort.refusals);
}

TEST(PlanCover, SaysWhyAClosedBodyCannotBeWound) {
    const Mandrel torus = test::made("torus", {{"ring-radius", 60.0}, {"tube-radius", 20.0}}, 8.0);
    ASSERT_TRUE(torus.rims.empty());
    const Plan plan = cover(torus, 100);
    EXPECT_NE(plan.failure, "");
    EXPECT_TRUE(plan.pieces.empty());
}

TEST(PlanCover, SaysWhyNothingIsAdmissible) {
    CoverOptions options;
    options.tow.friction = 0.0;  // nothing can be turned
    options.candidates = 50;
    options.rounds = 0;
    const Plan plan =
        plan_cover(test::wound_cylinder(),
                   test::obstacles_of(test::wound_cylinder(), 100.0, test::kTable_mm), options)
            .plan;
    EXPECT_NE(plan.failure, "");
    const auto refused = [&](CandidateFault reason) {
        return plan.effort.refusals[static_cast<std::size_t>(reason)];
    };
    EXPECT_EQ(refused(CandidateFault::NotTurnable) + refused(CandidateFault::NoRim),
              plan.effort.candidates);
    EXPECT_GT(refused(CandidateFault::NotTurnable), refused(CandidateFault::NoRim));
    EXPECT_TRUE(plan.pieces.empty());
}

// On what a cover has left, rims and all, the next one joins and covers as well, within what plans
// of one mandrel differ by.
TEST(PlanCover, CoversASecondTime) {
    constexpr double kEdge_mm = 4.0;
    const Mandrel pipe = test::made_cylinder(30.0, 160.0, kEdge_mm);
    const Plan first = cover(pipe, 2000);
    ASSERT_EQ(first.failure, "");
    const auto thickness = build_up_mm(pipe.surface, first.face_layers, 12.0, 0.5);
    const auto [least, most] = std::minmax_element(thickness.begin(), thickness.end());
    EXPECT_GT(*most - *least, 0.1);  // a fifth of a ply
    const Mandrel grown = thicken(pipe, thickness);
    const Plan second = cover(grown, 2000);
    ASSERT_EQ(second.failure, "");
    EXPECT_EQ(second.fibres, 1);
    EXPECT_GT(second.coverage.fraction, first.coverage.fraction - 0.02);
    EXPECT_LT(second.worst_joint_mm, kEdge_mm * kEdge_mm / (8.0 * 30.0));  // the sagitta
    test::expect_continuous(second);
    expect_books_to_balance(grown, second);
}

// The branch of the small tee leaves its run of 30 mm along x.
bool on_branch(const Eigen::Vector3d& position_mm) {
    return position_mm.x() > 45.0;
}

// A stage that asks for two layers on the branch or on the run, and for none elsewhere.
StageAsk ask_of_tee(bool branch) {
    const auto asked = [&](Stream stream) {
        AskedPlaces places;
        const CoverageSamples samples = plan_samples(tee().surface, 12.0, 1, stream);
        places.at = samples.at;
        for (const Eigen::Vector3d& position : samples.position_mm) {
            places.layers.push_back(on_branch(position) == branch ? 2 : 0);
        }
        return places;
    };
    StageAsk ask;
    ask.measured = asked(Stream::Sampling);
    ask.weighed = asked(Stream::Ground);
    ask.left = ask.measured.layers;
    return ask;
}

// Layers on the branch over those on the run, by the middles of the triangles.
double branch_over_run(const Plan& plan) {
    std::array<double, 2> layers{};
    std::array<double, 2> wall_mm2{};
    const Surface& surface = tee().surface;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const SurfacePoint middle{.face = static_cast<std::int32_t>(f)};
        const std::size_t where = on_branch(position_mm(surface, middle)) ? 1 : 0;
        const double mm2 = area_mm2(surface.position_mm, surface.face[f]);
        wall_mm2[where] += mm2;
        layers[where] += mm2 * plan.face_layers[f];
    }
    return layers[1] / wall_mm2[1] / (layers[0] / wall_mm2[0]);
}

// Fibre goes where layers lack. Courses to the branch cross the run, so not all of it can.
TEST(PlanCover, AStageLaysFibreWhereItIsAsked) {
    const StageAsk for_branch = ask_of_tee(true);
    const StageAsk for_run = ask_of_tee(false);
    const Plan branch = cover(tee(), 4000, 1, 40.0, &for_branch);
    const Plan run = cover(tee(), 4000, 1, 40.0, &for_run);
    ASSERT_EQ(branch.failure, "");
    ASSERT_EQ(run.failure, "");
    EXPECT_GT(branch_over_run(branch), 1.5 * branch_over_run(run));
    for (const Plan* plan : {&branch, &run}) {
        EXPECT_EQ(plan->reached.size(), for_run.measured.at.size());
        ASSERT_TRUE(plan->least_fibre_mm.has_value());
        EXPECT_GT(*plan->least_fibre_mm, 0.0);
        EXPECT_LT(*plan->least_fibre_mm, plan->fibre_length_mm);
    }
}

// A cylinder that goes over into a cone at a sharp convex edge and back at a sharp concave one:
// courses that run over the edges are geodesics there and hold.
TEST(PlanCover, CoversAReducerWithSharpEdges) {
    constexpr int kAround = 60;
    constexpr std::array<std::array<double, 2>, 4> kProfile{
        {{22.0, 0.0}, {22.0, 60.0}, {14.0, 68.0}, {14.0, 120.0}}};
    TriangleSoup soup;
    std::vector<std::array<double, 2>> rings;
    for (std::size_t k = 0; k + 1 < kProfile.size(); ++k) {
        const auto [r0, z0] = kProfile[k];
        const auto [r1, z1] = kProfile[k + 1];
        const int steps = static_cast<int>(std::ceil(std::hypot(r1 - r0, z1 - z0) / 2.5));
        for (int i = 0; i < steps; ++i) {
            const double share = static_cast<double>(i) / steps;
            rings.push_back({r0 + share * (r1 - r0), z0 + share * (z1 - z0)});
        }
    }
    rings.push_back(kProfile.back());
    for (const auto& [radius, z] : rings) {
        for (int j = 0; j < kAround; ++j) {
            const double angle = 2.0 * kPi * j / kAround;
            soup.points_mm.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
        }
    }
    for (std::int32_t i = 0; i + 1 < static_cast<std::int32_t>(rings.size()); ++i) {
        for (std::int32_t j = 0; j < kAround; ++j) {
            const std::int32_t a = i * kAround + j;
            const std::int32_t b = i * kAround + (j + 1) % kAround;
            soup.faces.push_back({a, b, b + kAround});
            soup.faces.push_back({a, b + kAround, a + kAround});
        }
    }
    const Mandrel mandrel = build_mandrel(soup, "reducer", {.unit_mm = 1.0});
    ASSERT_EQ(mandrel.rims.size(), 2U);
    const Plan plan = cover(mandrel, 3000);
    ASSERT_EQ(plan.failure, "");
    EXPECT_EQ(plan.fibres, 1);
    EXPECT_GT(plan.coverage.fraction, 0.9);
    EXPECT_TRUE(std::any_of(plan.pieces.begin(), plan.pieces.end(), [](const Piece& piece) {
        return piece.kind == PieceKind::Course && piece.start_rim != piece.end_rim;
    }));
    test::expect_continuous(plan);
    expect_books_to_balance(mandrel, plan);
}

}  // namespace
}  // namespace meshwind
