// What is planned for each kind of layer, against closed forms on a pipe.
#include "pipeline/plan_layer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/any_machine.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using test::kPipeLength_mm;
using test::kPipeRadius_mm;
using test::kPipeTow_mm;

// The mesh's patches are off the ideal pipe by fourth order in edges of 6 mm.
constexpr double kOnWall_mm = 0.01;

// Samples for coverage stand a quarter of a tow apart: of 40 x 13 of them the mean is known to this
// share.
constexpr double kSampled = 0.02;

const meshwind::Setup& pipe_setup() {
    static const meshwind::Setup setup =
        make_setup(test::small_pipe(), test::shipped("six_axis"), test::pipe_job());
    return setup;
}

LayerJob layer_of(LayerKind kind, std::optional<double> angle_deg = {}) {
    LayerJob layer;
    layer.kind = kind;
    layer.angle_deg = angle_deg;
    return layer;
}

Plan planned(const LayerJob& layer, const meshwind::Setup& setup = pipe_setup()) {
    return plan_layer(setup, layer, test::AnyMachine()).plan;
}

std::vector<const Piece*> courses_of(const Plan& plan) {
    std::vector<const Piece*> courses;
    for (const Piece& piece : plan.pieces) {
        if (piece.kind == PieceKind::Course) {
            courses.push_back(&piece);
        }
    }
    return courses;
}

double azimuth_rad(const PathPoint& at) {
    return std::atan2(at.position_mm.y(), at.position_mm.x());
}

// Azimuths, 0 to 2 pi and ascending, at which the courses that go up begin.
std::vector<double> starts_of(const Plan& plan) {
    std::vector<double> starts;
    for (const Piece* course : courses_of(plan)) {
        if (course->path.front().tangent.z() > 0.0) {
            const double azimuth = azimuth_rad(course->path.front());
            starts.push_back(azimuth < 0.0 ? azimuth + 2.0 * kPi : azimuth);
        }
    }
    std::sort(starts.begin(), starts.end());
    return starts;
}

// A helix of the angle a from rim to rim is L / cos(a) long; bands of the width w that lie side by
// side are 2 pi R cos(a) / w, and N of them cover 2 N w / (2 pi R cos(a)) times.
TEST(PlanLayer, HelicesAreLaidAtTheAngleThatIsAskedFor) {
    for (const double angle_deg : {45.0, 60.0, 75.0}) {
        SCOPED_TRACE(angle_deg);
        const Plan plan = planned(layer_of(LayerKind::Helical, angle_deg));
        ASSERT_EQ(plan.failure, "");
        EXPECT_EQ(plan.planner, Planner::Pattern);
        ASSERT_TRUE(plan.pattern() != nullptr);
        const double cosine = std::cos(rad_from_deg(angle_deg));
        const double bands = 2.0 * kPi * kPipeRadius_mm * cosine / kPipeTow_mm;
        const auto circuits = static_cast<double>(plan.pattern()->pattern.circuits);
        EXPECT_GE(circuits, bands);
        EXPECT_LT(circuits, bands * 1.25 + 1.0);  // the default of most_overlap, and whole numbers
        EXPECT_EQ(plan.courses, 2 * plan.pattern()->pattern.circuits);
        EXPECT_EQ(plan.fibres, 1);
        EXPECT_NEAR(plan.coverage.mean_layers, 2.0 * circuits / bands,
                    kSampled * 2.0 * circuits / bands);
        EXPECT_GT(plan.coverage.fraction, 0.999);
        double sum_mm = 0.0;
        for (const Piece& piece : plan.pieces) {
            sum_mm += piece.path.back().s_mm;
        }
        EXPECT_NEAR(plan.fibre_length_mm, sum_mm, 1e-6);
        const std::vector<const Piece*> courses = courses_of(plan);
        ASSERT_EQ(courses.size(), static_cast<std::size_t>(plan.courses));
        for (const Piece* course : courses) {
            EXPECT_NEAR(course->path.back().s_mm, kPipeLength_mm / cosine, 2.0 * kOnWall_mm);
            for (const PathPoint& at : course->path) {
                // The normal's error, of third order: 6^3 / (30^2 384) of a rad.
                EXPECT_NEAR(std::abs(at.tangent.z()), cosine, 1e-3);
            }
        }
        // Courses are geodesics, turns use friction but leave some for the blocks. With the slip
        // ratio k a turn from the angle a to the hoop takes R / k (1 / sin(a) - 1) of the
        // extension: cot(a) falls by k / R per mm of fibre, and dz = cos(a) ds.
        EXPECT_LT(plan.worst_slip, pipe_setup().job.tow.friction);
        double run_mm = 0.0;
        for (const Piece& piece : plan.pieces) {
            for (const PathPoint& at : piece.path) {
                run_mm = std::max(run_mm, std::abs(at.position_mm.z()) - 0.5 * kPipeLength_mm);
            }
        }
        const double sine = std::sin(rad_from_deg(angle_deg));
        EXPECT_NEAR(run_mm, kPipeRadius_mm / plan.worst_slip * (1.0 / sine - 1.0), kOnWall_mm);
    }
}

TEST(PlanLayer, BandsLieEvenlyAroundAndTheFibreCloses) {
    const Plan plan = planned(layer_of(LayerKind::Helical, 50.0));
    ASSERT_TRUE(plan.pattern() != nullptr);
    const std::vector<double> starts = starts_of(plan);
    const auto circuits = static_cast<std::size_t>(plan.pattern()->pattern.circuits);
    ASSERT_EQ(starts.size(), circuits);
    for (std::size_t i = 1; i < starts.size(); ++i) {
        // Within the 0.01 deg to which patterns close.
        EXPECT_NEAR(starts[i] - starts[i - 1], 2.0 * kPi / static_cast<double>(circuits),
                    rad_from_deg(0.01));
    }
    EXPECT_LT(plan.worst_joint_mm, kOnWall_mm);
}

// Circuits lie in both hands: up to two layers are one cover of theirs.
TEST(PlanLayer, TwoCoversTakeTwiceTheFibre) {
    LayerJob layer = layer_of(LayerKind::Helical, 50.0);
    const Plan one = planned(layer);
    EXPECT_GE(one.coverage.mean_layers, 2.0 * (1.0 - kSampled));
    layer.target_layers = 2.0;
    EXPECT_EQ(planned(layer).pattern()->pattern.circuits, one.pattern()->pattern.circuits);
    layer.target_layers = 3.5;
    const Plan two = planned(layer);
    ASSERT_EQ(two.failure, "");
    // Whole numbers of circuits, and bands that may overlap by a quarter.
    const double bands = 2.0 * kPi * kPipeRadius_mm * std::cos(rad_from_deg(50.0)) / kPipeTow_mm;
    const auto circuits = static_cast<double>(two.pattern()->pattern.circuits);
    EXPECT_GE(circuits, 2.0 * bands);
    EXPECT_LT(circuits, 2.0 * bands * 1.25 + 1.0);
    EXPECT_NEAR(two.coverage.mean_layers / one.coverage.mean_layers,
                circuits / static_cast<double>(one.pattern()->pattern.circuits), 2.0 * kSampled);
}

TEST(PlanLayer, CircuitsAndStartsAreThoseAskedFor) {
    LayerJob layer = layer_of(LayerKind::Helical, 50.0);
    layer.pattern = PatternJob{.circuits = 14, .starts = 3};
    const Plan plan = planned(layer);
    ASSERT_EQ(plan.failure, "");
    EXPECT_EQ(plan.pattern()->pattern.circuits, 14);
    EXPECT_EQ(plan.pattern()->pattern.starts, 3);
    // Three circuits on a band lies beside the first: a fourteenth of a turn from it.
    std::vector<double> up;
    for (const Piece* course : courses_of(plan)) {
        if (course->path.front().tangent.z() > 0.0) {
            up.push_back(azimuth_rad(course->path.front()));
        }
    }
    ASSERT_EQ(up.size(), 14U);
    EXPECT_NEAR(std::abs(std::remainder(up[3] - up[0], 2.0 * kPi)), 2.0 * kPi / 14.0,
                rad_from_deg(0.01));
    // Of N circuits at most N / 2 lie between neighbours.
    layer.pattern = PatternJob{.circuits = 14, .starts = 8};
    EXPECT_NE(planned(layer).failure, "");
}

// Whole turns half a band from either end, and between them a pitch of at most the band: n >= (L -
// w) / w + 2 turns, of the length 2 pi R each but for the pitch, (w / 2 pi R)^2 / 2 = 0.2 %.
TEST(PlanLayer, HoopsCoverThePipeSideBySide) {
    const Plan plan = planned(layer_of(LayerKind::Hoop));
    ASSERT_EQ(plan.failure, "");
    EXPECT_EQ(plan.courses, 1);
    EXPECT_GT(plan.coverage.fraction, 0.999);
    double turned_rad = 0.0;
    double low_mm = HUGE_VAL;
    double high_mm = -HUGE_VAL;
    const SurfacePath& path = courses_of(plan).front()->path;
    for (std::size_t i = 0; i < path.size(); ++i) {
        low_mm = std::min(low_mm, path[i].position_mm.z());
        high_mm = std::max(high_mm, path[i].position_mm.z());
        if (i > 0) {
            turned_rad +=
                std::remainder(azimuth_rad(path[i]) - azimuth_rad(path[i - 1]), 2.0 * kPi);
        }
    }
    const double to_mm = 0.5 * (kPipeLength_mm - kPipeTow_mm);
    EXPECT_NEAR(low_mm, -to_mm, kOnWall_mm);
    EXPECT_NEAR(high_mm, to_mm, kOnWall_mm);
    const double turns = std::abs(turned_rad) / (2.0 * kPi);
    EXPECT_GE(turns, (kPipeLength_mm - kPipeTow_mm) / kPipeTow_mm + 2.0);
    EXPECT_LT(turns, (kPipeLength_mm - kPipeTow_mm) / kPipeTow_mm + 3.0);
    EXPECT_NEAR(path.back().s_mm, turns * 2.0 * kPi * kPipeRadius_mm, 0.002 * path.back().s_mm);
}

TEST(PlanLayer, RibsOfALatticeAreAsFarApartAsTheirNumberSays) {
    LayerJob layer = layer_of(LayerKind::Lattice, 50.0);
    layer.lattice = LatticeConstraints{.circuits = 4, .series = 1, .plies = 1};
    const Plan plan = planned(layer);
    ASSERT_EQ(plan.failure, "");
    EXPECT_EQ(plan.courses, 8);
    const std::vector<double> starts = starts_of(plan);
    ASSERT_EQ(starts.size(), 4U);
    for (std::size_t i = 1; i < starts.size(); ++i) {
        EXPECT_NEAR(starts[i] - starts[i - 1], 0.5 * kPi, rad_from_deg(0.01));
    }
    ASSERT_TRUE(plan.pattern() != nullptr && plan.pattern()->lattice);
    EXPECT_NEAR(plan.pattern()->lattice->rib_spacing_mm,
                0.5 * kPi * kPipeRadius_mm * std::cos(rad_from_deg(50.0)), 1e-6);
    EXPECT_FALSE(plan.pattern()->lattice->filled);
    // Of N bands w wide in either direction the share p = N w / (2 pi R cos(a)) is under each, and
    // crossings are counted twice: 1 - (1 - p)^2.
    const double p =
        4.0 * kPipeTow_mm / (2.0 * kPi * kPipeRadius_mm * std::cos(rad_from_deg(50.0)));
    EXPECT_NEAR(plan.coverage.fraction, 1.0 - (1.0 - p) * (1.0 - p), kSampled);
}

// The same vessel by each turn: without extensions nothing lies beyond the wall.
TEST(PlanLayer, PolarWindingsTouchTheOpenings) {
    const double opening_mm = 12.0;
    const Mandrel vessel = test::made("vessel",
                                      {{"radius", 40.0},
                                       {"cylinder-length", 80.0},
                                       {"dome-height", 28.0},
                                       {"opening-radius", opening_mm}},
                                      6.0);
    Job job;
    job.tow.width_mm = 10.0;
    job.mandrel.turn = TurnKind::Pole;
    const meshwind::Setup setup = make_setup(vessel, test::shipped("six_axis"), job);
    const Plan plan = planned(layer_of(LayerKind::Polar), setup);
    ASSERT_EQ(plan.failure, "");
    double least_mm = HUGE_VAL;
    for (const Piece& piece : plan.pieces) {
        EXPECT_EQ(piece.kind, PieceKind::Course);
        for (const PathPoint& at : piece.path) {
            // Clairaut's constant r sin(a) of all of the fibre: radius of the pole's circle. The
            // patches of a dome of edges of 6 mm are off it by 0.05 mm, as pattern_plan_test.cpp
            // has it.
            const Vector3d around = Vector3d::UnitZ().cross(at.position_mm);
            EXPECT_NEAR(std::abs(around.dot(at.tangent)),
                        40.0 * std::sin(plan.pattern()->angle_rad), 0.1);
            least_mm = std::min(least_mm, at.position_mm.head<2>().norm());
        }
    }
    // The band touches the opening; the pattern closes by giving way to the angle, by 3 degrees at
    // most.
    EXPECT_NEAR(least_mm, opening_mm + 5.0, 40.0 * rad_from_deg(3.0));
    EXPECT_GT(plan.coverage.fraction, kCoveredShare);
}

TEST(PlanLayer, APipeHasNoPolesToTurnAbout) {
    Job job = test::pipe_job();
    job.mandrel.turn = TurnKind::Pole;
    const meshwind::Setup setup = make_setup(test::small_pipe(), test::shipped("six_axis"), job);
    for (const LayerKind kind : {LayerKind::Helical, LayerKind::Auto, LayerKind::Cover}) {
        const Plan plan = planned(layer_of(kind, 50.0), setup);
        EXPECT_NE(plan.failure, "") << name_of(kind);
        EXPECT_TRUE(plan.pieces.empty());
    }
}

TEST(PlanLayer, ElbowsHaveLinesAndNoOtherPattern) {
    const double pipe_mm = 40.0;
    const double bend_mm = 120.0;
    Job job;
    job.tow.width_mm = 20.0;
    const meshwind::Setup setup = make_setup(test::made("elbow",
                                                        {{"pipe-radius", pipe_mm},
                                                         {"bend-radius", bend_mm},
                                                         {"angle", 0.5 * kPi},
                                                         {"leg1", 150.0},
                                                         {"leg2", 150.0}},
                                                        8.0),
                                             test::shipped("six_axis"), job);
    LayerJob layer = layer_of(LayerKind::Helical, 78.0);
    const Plan plan = planned(layer, setup);
    ASSERT_EQ(plan.failure, "");
    EXPECT_EQ(plan.planner, Planner::Elbow);
    ASSERT_TRUE(plan.elbow() != nullptr);
    EXPECT_EQ(plan.courses, 2 * plan.elbow()->lines);
    EXPECT_NEAR(plan.elbow()->angle_rad, rad_from_deg(78.0), 1e-9);
    // Clairaut on the torus: (B + r) sin(a) at the outer equator is (B - r) sin at the inner one.
    EXPECT_GT(plan.coverage.fraction, kCoveredShare);
    EXPECT_LT(plan.worst_slip, job.tow.friction);
    for (const LayerKind kind : {LayerKind::Hoop, LayerKind::Polar}) {
        EXPECT_NE(planned(layer_of(kind), setup).failure, "") << name_of(kind);
    }
    layer.pattern = PatternJob{.circuits = 14};
    EXPECT_NE(planned(layer, setup).failure, "");
}

TEST(PlanLayer, SeedsDrawSamplesAndNothingElseOfAPattern) {
    const LayerJob layer = layer_of(LayerKind::Helical, 50.0);
    const auto with_seed = [&](std::uint64_t seed) {
        LayerPlanOptions options;
        options.context.seed = seed;
        return plan_layer(pipe_setup(), layer, test::AnyMachine(), options).plan;
    };
    const Plan one = with_seed(1);
    const Plan again = with_seed(1);
    const Plan other = with_seed(2);
    EXPECT_EQ(one.coverage.mean_layers, again.coverage.mean_layers);
    EXPECT_NE(one.coverage.mean_layers, other.coverage.mean_layers);
    EXPECT_NEAR(one.coverage.mean_layers, other.coverage.mean_layers,
                kSampled * one.coverage.mean_layers);
    ASSERT_EQ(one.pieces.size(), other.pieces.size());
    for (std::size_t i = 0; i < one.pieces.size(); ++i) {
        ASSERT_EQ(one.pieces[i].path.size(), other.pieces[i].path.size());
        EXPECT_EQ(one.pieces[i].path.back().position_mm, other.pieces[i].path.back().position_mm);
    }
}

TEST(LeastCovered, IsWhatTheFibresJoinButNotLittleOfTheReach) {
    Coverage coverage;
    coverage.reachable = 0.98;
    EXPECT_DOUBLE_EQ(least_covered(coverage, 0.01), 0.97);
    coverage.joinable = 0.95;
    EXPECT_DOUBLE_EQ(least_covered(coverage, 0.01), 0.94);
    coverage.joinable = 0.5;
    EXPECT_DOUBLE_EQ(least_covered(coverage, 0.01), 0.9 * 0.98 - 0.01);
    EXPECT_EQ(least_covered(coverage, 1.0), 0.0);
}

}  // namespace
}  // namespace meshwind
