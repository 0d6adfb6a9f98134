// How often the wall is covered, for tows of any width on meshes of any edge: against closed forms,
// and against an unrolled grid that knows no mesh.
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/revolution/revolution.h"
#include "mesh/shapes/make.h"
#include "tests/support/fixtures.h"
#include "winding/cover/cover.h"
#include "winding/elbow/elbow_plan.h"
#include "winding/revolution/pattern_plan.h"

namespace meshwind {
namespace {

constexpr double kRadius_mm = 27.5;
constexpr double kLength_mm = 90.0;
constexpr double kAngle_rad = rad_from_deg(62.0);

// "mean layers ... within 1 %"
constexpr double kMean = 0.01;

// What facets have less than the wall that they stand for: 2 % with edges of 20 mm.
double missing_area(const Surface& surface) {
    return 1.0 - test::wall_area_mm2(surface) / (2.0 * kPi * kRadius_mm * kLength_mm);
}

double mean_of_faces(const Surface& surface, const Plan& plan) {
    double sum = 0.0;
    double area = 0.0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const double face_mm2 = area_mm2(surface.position_mm, surface.face[f]);
        sum += plan.face_layers[f] * face_mm2;
        area += face_mm2;
    }
    return sum / area;
}

double course_length_mm(const Plan& plan) {
    double length = 0.0;
    for (const Piece& piece : plan.pieces) {
        length += piece.kind == PieceKind::Course ? piece.path.back().s_mm - piece.path.front().s_mm
                                                  : 0.0;
    }
    return length;
}

// Mean layers of the cylinder's courses on a grid of its unrolled wall, with straight bands from
// station to station.
double unrolled_mean(const Plan& plan, double tow_width_mm, double from_mm, double to_mm) {
    constexpr double kGrid_mm = 0.2;
    const double girth = 2.0 * kPi * kRadius_mm;
    const auto across = static_cast<std::size_t>(girth / kGrid_mm);
    const auto along = static_cast<std::size_t>((to_mm - from_mm) / kGrid_mm);
    double sum = 0.0;
    for (const Piece& piece : plan.pieces) {
        for (std::size_t i = 1; piece.kind == PieceKind::Course && i < piece.path.size(); ++i) {
            const Eigen::Vector3d& a = piece.path[i - 1].position_mm;
            const Eigen::Vector3d& b = piece.path[i].position_mm;
            const double a_mm = kRadius_mm * std::atan2(a.y(), a.x());
            const double b_mm =
                a_mm + std::remainder(kRadius_mm * std::atan2(b.y(), b.x()) - a_mm, girth);
            const Eigen::Vector2d first(a_mm, a.z());
            const Eigen::Vector2d step = Eigen::Vector2d(b_mm, b.z()) - first;
            const double length = step.norm();
            const double reach = length + tow_width_mm;
            const auto column = [&](double x) { return std::lround(x / girth * double(across)); };
            const auto row = [&](double z) {
                return std::lround((z - from_mm) / (to_mm - from_mm) * double(along));
            };
            for (long u = column(a_mm - reach); length > 0.0 && u <= column(a_mm + reach); ++u) {
                for (long v = std::max(0L, row(a.z() - reach));
                     v < std::min(long(along), row(a.z() + reach)); ++v) {
                    const Eigen::Vector2d place(
                        (double(u) + 0.5) * girth / double(across),
                        from_mm + (double(v) + 0.5) * (to_mm - from_mm) / double(along));
                    const Eigen::Vector2d off = place - first;
                    const double ahead = off.dot(step) / length;
                    const double beside = (off.x() * step.y() - off.y() * step.x()) / length;
                    sum += ahead >= 0.0 && ahead < length && std::abs(beside) <= 0.5 * tow_width_mm
                               ? 1.0
                               : 0.0;
                }
            }
        }
    }
    return sum / double(across * along);
}

class PatternOfTow : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(PatternOfTow, HasTheMeanLayersOfItsBands) {
    const auto [width_mm, edge_mm] = GetParam();
    const Mandrel mandrel = test::made_cylinder(kRadius_mm, kLength_mm, edge_mm);
    PatternOptions options{.angle_rad = kAngle_rad};
    options.tow = {.width_mm = width_mm, .thickness_mm = 0.1, .friction = 0.2};
    options.turn.extension_mm = 100.0;
    const Plan plan = plan_pattern(mandrel, *find_revolution(mandrel).body, options);
    ASSERT_EQ(plan.failure, "");
    const double bands = 2.0 * static_cast<double>(plan.pattern()->pattern.circuits) * width_mm;
    const double expected = bands / (2.0 * kPi * kRadius_mm * std::cos(kAngle_rad));
    const double tolerance = kMean + missing_area(mandrel.surface);
    EXPECT_NEAR(plan.coverage.mean_layers / expected, 1.0, tolerance);
    EXPECT_NEAR(mean_of_faces(mandrel.surface, plan) / expected, 1.0, tolerance);
    EXPECT_GT(plan.coverage.fraction, 0.99);
}

INSTANTIATE_TEST_SUITE_P(Widths, PatternOfTow,
                         testing::Combine(testing::Values(1.0, 2.0, 2.8, 6.0, 20.0),
                                          testing::Values(1.0, 4.0, 20.0)));

TEST(NarrowTow, RibsOfALatticeHaveTheirMeanLayers) {
    for (const auto& [width_mm, edge_mm] :
         {std::pair{1.0, 20.0}, {1.0, 5.0}, {2.8, 1.0}, {8.0, 20.0}, {8.0, 1.0}}) {
        const Mandrel mandrel = test::made_cylinder(kRadius_mm, kLength_mm, edge_mm);
        PatternOptions options{.angle_rad = rad_from_deg(45.0)};
        options.tow = {.width_mm = width_mm, .thickness_mm = 0.1, .friction = 0.2};
        options.turn.extension_mm = 100.0;
        options.lattice = LatticeConstraints{.circuits = 7};
        const Plan plan = plan_pattern(mandrel, *find_revolution(mandrel).body, options);
        ASSERT_EQ(plan.failure, "");
        const double bands = 2.0 * static_cast<double>(plan.pattern()->pattern.circuits) * width_mm;
        EXPECT_NEAR(plan.coverage.mean_layers * 2.0 * kPi * kRadius_mm * std::sqrt(0.5) / bands,
                    1.0, kMean + missing_area(mandrel.surface))
            << "tow " << width_mm << " edge " << edge_mm;
    }
}

TEST(NarrowTow, CoverAgreesWithAnUnrolledGrid) {
    for (const auto& [width_mm, edge_mm] : {std::pair{1.5, 5.0}, {4.0, 1.5}}) {
        const Mandrel mandrel = test::made_cylinder(kRadius_mm, 60.0, edge_mm);
        CoverOptions options;
        options.tow = {.width_mm = width_mm, .thickness_mm = 0.1, .friction = 0.25};
        options.turns.rule.extension_mm = 100.0;
        options.free_fibre.start_mm = 2.0 * edge_mm;
        options.candidates = 500;
        options.rounds = 0;
        options.scarce_candidates = 0;
        options.context.effort = 0.1;
        const Plan plan =
            plan_cover(mandrel, test::obstacles_of(mandrel, 100.0, 60.0), options).plan;
        ASSERT_EQ(plan.failure, "");
        const auto [low, high] = std::minmax_element(
            mandrel.surface.position_mm.begin(), mandrel.surface.position_mm.end(),
            [](const auto& a, const auto& b) { return a.z() < b.z(); });
        const double expected = unrolled_mean(plan, width_mm, low->z(), high->z());
        ASSERT_GT(expected, 0.2);
        EXPECT_NEAR(plan.coverage.mean_layers / expected, 1.0, kMean)
            << "tow " << width_mm << " edge " << edge_mm;
        EXPECT_NEAR(mean_of_faces(mandrel.surface, plan) / expected, 1.0, kMean);
    }
}

TEST(NarrowTow, TapeOnAnElbowCoversItsLengthTimesItsWidth) {
    for (const auto& [width_mm, edge_mm] : {std::pair{1.0, 6.0}, {3.0, 1.5}}) {
        const Mandrel mandrel = build_mandrel(
            make_elbow({20.0, 60.0, rad_from_deg(60.0), 40.0, 40.0}, {.edge_mm = edge_mm}), "elbow",
            {.unit_mm = 1.0});
        const TubeFinding found = find_tube(mandrel);
        ASSERT_TRUE(found.tube) << found.why_not;
        ElbowPlanOptions options;
        options.tow = {.width_mm = width_mm, .thickness_mm = 0.1, .friction = 0.3};
        options.turn.extension_mm = 100.0;
        const Plan plan = plan_elbow(mandrel, *found.tube, options);
        ASSERT_EQ(plan.failure, "");
        const double expected =
            course_length_mm(plan) * width_mm / test::wall_area_mm2(mandrel.surface);
        EXPECT_NEAR(plan.coverage.mean_layers / expected, 1.0, kMean)
            << "tow " << width_mm << " edge " << edge_mm;
        EXPECT_NEAR(mean_of_faces(mandrel.surface, plan) / expected, 1.0, kMean);
    }
}

}  // namespace
}  // namespace meshwind
