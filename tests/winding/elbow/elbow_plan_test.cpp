#include "winding/elbow/elbow_plan.h"

#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/shapes/make.h"
#include "mesh/shapes/make_kinds.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

Mandrel part(const TriangleSoup& soup) {
    return build_mandrel(soup, "part", {.unit_mm = 1.0});
}

Plan planned(const Mandrel& mandrel, std::optional<double> angle_deg, double extension_mm = 100.0) {
    const TubeFinding found = find_tube(mandrel);
    EXPECT_TRUE(found.tube) << found.why_not;
    ElbowPlanOptions options;
    if (angle_deg) {
        options.angle_rad = rad_from_deg(*angle_deg);
    }
    options.turn.extension_mm = extension_mm;
    return plan_elbow(mandrel, *found.tube, options);
}

TEST(ElbowPlan, IsOneFibreThroughAllLinesOfBothHands) {
    for (const bool irregular : {false, true}) {
        const ElbowShape shape{30.0, 90.0, rad_from_deg(70.0), 90.0, 110.0};
        const Mandrel mandrel = part(make_elbow(shape, {.edge_mm = 5.0, .irregular = irregular}));
        const Plan plan = planned(mandrel, 76.0);
        ASSERT_TRUE(plan.failure.empty()) << plan.failure;
        ASSERT_NE(plan.elbow(), nullptr);
        EXPECT_EQ(plan.courses, 2 * plan.elbow()->lines);
        EXPECT_EQ(plan.fibres, 1);
        EXPECT_LT(plan.worst_joint_mm, 1e-9);
        std::array<int, 2> senses{};
        std::set<std::pair<int, int>> starts;  // each at another place of its rim
        for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
            const Piece& piece = plan.pieces[i];
            EXPECT_EQ(piece.kind, i % 2 == 0 ? PieceKind::Course : PieceKind::Transition);
            if (i > 0) {
                // No kink from piece to piece.
                EXPECT_LT(
                    (piece.path.front().tangent - plan.pieces[i - 1].path.back().tangent).norm(),
                    1e-6);
            }
            if (piece.kind == PieceKind::Course) {
                const Rim& rim = mandrel.rims[static_cast<std::size_t>(piece.start_rim)];
                const RimCrossing at =
                    crossing_at(rim, piece.path.front().position_mm, -piece.path.front().tangent);
                const double place = at.azimuth_rad * plan.elbow()->lines / (2.0 * kPi);
                EXPECT_TRUE(
                    starts.insert({piece.start_rim, static_cast<int>(std::lround(100.0 * place))})
                        .second);
                // One hand up, the other down: over each rim all go round the same way.
                EXPECT_EQ(piece.end_rim, 1 - piece.start_rim);
                EXPECT_EQ(piece.start_rim,
                          plan.pieces.front().start_rim == 0 ? i / 2 % 2 : 1 - i / 2 % 2);
                int& sense = senses.at(static_cast<std::size_t>(piece.start_rim));
                EXPECT_TRUE(sense == 0 || sense == at.sense);
                sense = at.sense;
            }
        }
        EXPECT_EQ(starts.size(), static_cast<std::size_t>(plan.courses));
        EXPECT_GT(plan.coverage.fraction, 0.998);
        EXPECT_EQ(plan.coverage.reachable, 1.0);
        ASSERT_TRUE(plan.coverage.regular_cv);
        EXPECT_LT(*plan.coverage.regular_cv, 0.03);
        EXPECT_LT(plan.worst_slip, 0.2);
        EXPECT_LT(plan.worst_bridge_mm, 0.01);
        // Within a tow width layers are averaged: between equator and that.
        EXPECT_NEAR(*plan.coverage.thinnest_layers, plan.elbow()->thinnest_layers, 0.25);
        EXPECT_NEAR(*plan.coverage.thickest_layers, plan.elbow()->thickest_layers, 0.4);
    }
}

// Stations are on the made shape, and their faces under them: irregular edges are up to twice as
// long as asked for and sag by up to 10^2 / (8 * 30) = 0.42 mm.
TEST(ElbowPlan, StationsLieOnTheWall) {
    const ElbowShape shape{30.0, 90.0, rad_from_deg(70.0), 90.0, 110.0};
    const Mandrel mandrel = part(make_elbow(shape, {.edge_mm = 5.0, .irregular = true}));
    const Plan plan = planned(mandrel, 76.0);
    ASSERT_TRUE(plan.failure.empty()) << plan.failure;
    const Eigen::Affine3d to_file = mandrel.file_to_mandrel.inverse();
    for (const Piece& piece : plan.pieces) {
        if (piece.kind != PieceKind::Course) {
            continue;
        }
        for (const PathPoint& point : piece.path) {
            EXPECT_NEAR(elbow_foot(shape, to_file * point.position_mm).distance_mm, 0.0, 1e-7);
            EXPECT_LT((position_mm(mandrel.surface, point.at) - point.position_mm).norm(), 0.42);
            EXPECT_NEAR(point.normal.dot(point.tangent), 0.0, 1e-12);
        }
    }
}

TEST(ElbowPlan, ChoosesAnAngleItself) {
    const Mandrel mandrel =
        part(make_elbow({30.0, 90.0, rad_from_deg(70.0), 90.0, 110.0}, {.edge_mm = 6.0}));
    const Plan plan = planned(mandrel, std::nullopt);
    ASSERT_TRUE(plan.failure.empty()) << plan.failure;
    EXPECT_GT(plan.coverage.fraction, 0.998);
    EXPECT_EQ(plan.coverage.reachable, 1.0);
    const auto fibre_mm = [](const Plan& of) {
        double length = 0.0;
        for (const Piece& piece : of.pieces) {
            length += piece.kind == PieceKind::Course ? piece.path.back().s_mm : 0.0;
        }
        return length;
    };
    // Other whole degrees up to 82 take more fibre, or leave gaps, or do not turn.
    const double chosen = std::round(deg_from_rad(plan.elbow()->angle_rad));
    for (const double other_deg : {chosen - 5.0, chosen - 1.0, chosen + 1.0, 82.0}) {
        if (other_deg > 82.0 || other_deg == chosen) {
            continue;
        }
        const Plan other = planned(mandrel, other_deg);
        EXPECT_TRUE(!other.failure.empty() || other.coverage.reachable < 1.0 ||
                    fibre_mm(other) > fibre_mm(plan))
            << chosen << ' ' << other_deg;
    }
}

TEST(ElbowPlan, SaysWhyNot) {
    const Mandrel mandrel =
        part(make_elbow({30.0, 90.0, rad_from_deg(70.0), 60.0, 60.0}, {.edge_mm = 8.0}));
    const auto has = [](const std::string& text, const char* words) {
        return text.find(words) != std::string::npos;
    };
    EXPECT_PRED2(has, planned(mandrel, 50.0).failure, "lifts off at the inner one");
    EXPECT_PRED2(has, planned(mandrel, 74.0, 4.0).failure, "mm of extension where there are 4.0");
    EXPECT_PRED2(has, planned(mandrel, std::nullopt, 1.0).failure, "at no angle from");
    const Mandrel pipe = part(make_mandrel("cylinder", {}, {.edge_mm = 10.0}));
    EXPECT_PRED2(has, planned(pipe, 60.0).failure, "this tube has 0 bends");
}

}  // namespace
}  // namespace meshwind
