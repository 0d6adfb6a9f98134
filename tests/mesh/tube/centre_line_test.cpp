#include "mesh/tube/centre_line.h"

#include <cmath>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

CentrePlace start_at(const Vector3d& position) {
    CentrePlace start;
    start.position_mm = position;
    return start;
}

// 100 up z, a quarter of radius 50 towards x, then 50 along x, a half turn of radius 30 towards y.
CentreLine bent() {
    return {start_at({1.0, 2.0, 3.0}),
            {{100.0, {0.0, 0.0}},
             {25.0 * kPi, {0.02, 0.0}},
             {50.0, {0.0, 0.0}},
             {30.0 * kPi, {0.0, 1.0 / 30.0}}}};
}

TEST(CentreLine, LinesAndArcsLieWhereTheyMust) {
    const CentreLine line = bent();
    EXPECT_NEAR(line.length_mm(), 150.0 + 55.0 * kPi, 1e-12);
    const auto nodes = line.nodes();
    ASSERT_EQ(nodes.size(), 5U);
    EXPECT_LT((nodes[1].position_mm - Vector3d(1, 2, 103)).norm(), 1e-12);
    EXPECT_LT((nodes[2].position_mm - Vector3d(51, 2, 153)).norm(), 1e-12);
    EXPECT_LT((nodes[2].tangent - Vector3d::UnitX()).norm(), 1e-14);
    EXPECT_LT((nodes[2].reference + Vector3d::UnitZ()).norm(), 1e-14);
    EXPECT_LT((nodes[4].position_mm - Vector3d(101, 62, 153)).norm(), 1e-12);
    EXPECT_LT((nodes[4].tangent + Vector3d::UnitX()).norm(), 1e-14);
    const CentrePlace middle = line.at(100.0 + 12.5 * kPi);
    const double h = std::sqrt(0.5);
    EXPECT_LT((middle.position_mm - Vector3d(51 - 50 * h, 2, 103 + 50 * h)).norm(), 1e-12);
    EXPECT_LT((middle.curvature_per_mm - 0.02 * Vector3d(h, 0, -h)).norm(), 1e-14);
    // Straight on beyond both ends.
    EXPECT_LT((line.at(-7.0).position_mm - Vector3d(1, 2, -4)).norm(), 1e-12);
    EXPECT_LT((line.at(line.length_mm() + 7.0).position_mm - Vector3d(94, 62, 153)).norm(), 1e-11);
}

TEST(CentreLine, FeetOfPlacesBesideItAreThosePlaces) {
    const CentreLine line = bent();
    for (int i = -20; i <= 340; ++i) {
        const CentrePlace place = line.at(static_cast<double>(i));
        for (int k = 0; k < 5; ++k) {
            // Nearer than the least bend radius; square to the line.
            const double angle = 1.3 * k + 0.1 * i;
            const Vector3d point = place.position_mm + 20.0 * (std::cos(angle) * place.reference +
                                                               std::sin(angle) * place.across());
            const CentrePlace foot = line.foot(point);
            EXPECT_NEAR(foot.arc_mm, place.arc_mm, 1e-10) << i << " " << k;
        }
    }
}

// The frame may turn with the tangent only: on a helix of radius a and slope angle g the reference
// falls back behind the normal by the torsion, sin(g) cos(g) / a per mm.
TEST(CentreLine, ThroughPointsOfAHelixConvergesWithoutTwist) {
    const double a = 60.0;
    const double g = 0.5;
    double last_place = 0.0;
    double last_twist = 0.0;
    for (const int count : {40, 80, 160}) {
        const double length = 300.0;
        const auto helix = [&](double s) -> Vector3d {
            const double angle = s * std::cos(g) / a;
            return {a * std::cos(angle), a * std::sin(angle), s * std::sin(g)};
        };
        const auto inward = [&](double s) -> Vector3d {
            const double angle = s * std::cos(g) / a;
            return {-std::cos(angle), -std::sin(angle), 0.0};
        };
        std::vector<Vector3d> points;
        for (int i = 0; i <= count; ++i) {
            points.push_back(helix(length * i / count));
        }
        const CentreLine line = line_through(points);
        double place = 0.0;
        for (int i = 0; i <= 200; ++i) {
            const Vector3d point = helix(length * i / 200);
            place = std::max(place, (line.foot(point).position_mm - point).norm());
        }
        const auto angle_at = [&](const CentrePlace& at, double s) {
            return std::atan2(inward(s).dot(at.across()), inward(s).dot(at.reference));
        };
        const double turned =
            angle_at(line.nodes().back(), length) - angle_at(line.nodes().front(), 0.0);
        const double torsion = std::sin(g) * std::cos(g) / a;
        const double twist = std::abs(std::remainder(turned - torsion * length, 2.0 * kPi));
        if (last_place > 0.0) {
            EXPECT_LT(place, last_place / 6.0) << count;  // order 3: 8
            EXPECT_LT(twist, last_twist / 3.0) << count;  // order 2: 4
        }
        last_place = place;
        last_twist = twist;
    }
    EXPECT_LT(last_place, 1e-3);
    EXPECT_LT(last_twist, 1e-3);
}

}  // namespace
}  // namespace meshwind
