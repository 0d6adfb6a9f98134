#include "mesh/revolution/rolled_meridian.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;

constexpr double kNarrow_mm = 20.0;
constexpr double kWide_mm = 30.0;

// Straight lines between (radius, z).
Meridian polygon(const std::vector<Vector2d>& corners) {
    std::vector<MeridianNode> nodes;
    nodes.reserve(corners.size());
    for (const Vector2d& corner : corners) {
        nodes.push_back({.radius_mm = corner.x(), .z_mm = corner.y(), .straight = true});
    }
    return Meridian(nodes);
}

// A pipe with a square shoulder at z = 0.
Meridian shouldered(double below_mm = 60.0) {
    return polygon({{kNarrow_mm, -below_mm}, {kNarrow_mm, 0.0}, {kWide_mm, 0.0}, {kWide_mm, 60.0}});
}

TEST(RolledMeridian, FillsAShoulderByAQuarterOfATorus) {
    constexpr double kBall_mm = 6.0;
    const RolledMeridian rolled = rolled_meridian(shouldered(), kBall_mm);
    ASSERT_TRUE(rolled.meridian) << rolled.why_not;
    // Pappus: the length of the arc, and what a quarter of a circle leaves of a square, on the ways
    // of their centroids.
    const double arc_off = kBall_mm * (1.0 - 2.0 / kPi);
    EXPECT_NEAR(rolled.area_mm2, 2.0 * kPi * (kNarrow_mm + arc_off) * 0.5 * kPi * kBall_mm,
                1e-7 * rolled.area_mm2);
    const double corner_mm2 = kBall_mm * kBall_mm * (1.0 - 0.25 * kPi);
    const double corner_off = kBall_mm * (10.0 - 3.0 * kPi) / (12.0 - 3.0 * kPi);
    EXPECT_NEAR(rolled.volume_mm3, 2.0 * kPi * (kNarrow_mm + corner_off) * corner_mm2,
                1e-4 * rolled.volume_mm3);
    const Meridian& meridian = *rolled.meridian;
    EXPECT_EQ(meridian.creases_mm().size(), 1U);  // the shoulder's own edge
    const Vector2d ball(kNarrow_mm + kBall_mm, -kBall_mm);
    for (const double share : {0.0, 0.3, 0.5, 0.9, 1.0}) {
        const double turn = 0.5 * kPi * share;
        const MeridianPlace at = meridian.at(60.0 - kBall_mm + share * 0.5 * kPi * kBall_mm);
        EXPECT_NEAR(at.radius_mm, ball.x() - kBall_mm * std::cos(turn), 1e-5);
        EXPECT_NEAR(at.z_mm, ball.y() + kBall_mm * std::sin(turn), 1e-5);
        EXPECT_NEAR(at.slope_rad, turn, 1e-5);
    }
    EXPECT_NEAR(meridian.at(62.0 * 2.0).radius_mm, kWide_mm, 1e-12);
}

// Too large for the shoulder, it rests on its edge.
TEST(RolledMeridian, RestsOnAnEdge) {
    constexpr double kBall_mm = 25.0;
    const RolledMeridian rolled = rolled_meridian(shouldered(), kBall_mm);
    ASSERT_TRUE(rolled.meridian) << rolled.why_not;
    const double down =
        std::sqrt(kBall_mm * kBall_mm - 15.0 * 15.0);  // 25 - 10 in front of the edge
    const Vector2d ball(kNarrow_mm + kBall_mm, -down);
    const Meridian& meridian = *rolled.meridian;
    ASSERT_EQ(meridian.creases_mm().size(), 1U);
    const MeridianPlace edge = meridian.at(meridian.creases_mm()[0]);
    EXPECT_NEAR(edge.radius_mm, kWide_mm, 1e-6);
    EXPECT_NEAR(edge.z_mm, 0.0, 1e-6);
    for (const double share : {0.1, 0.5, 0.9}) {
        const double arc = 60.0 - down + share * (meridian.creases_mm()[0] - (60.0 - down));
        const MeridianPlace at = meridian.at(arc);
        EXPECT_NEAR((Vector2d(at.radius_mm, at.z_mm) - ball).norm(), kBall_mm, 1e-5);
        EXPECT_NEAR(at.curvature_per_mm, -1.0 / kBall_mm, 1e-4);
    }
}

// Where a ball touches both a ball and a pipe is a triangle.
TEST(RolledMeridian, JoinsADomeToItsNeck) {
    constexpr double kDome_mm = 40.0;
    constexpr double kNeck_mm = 15.0;
    constexpr double kBall_mm = 8.0;
    std::vector<MeridianNode> nodes;
    constexpr int kSteps = 40;
    const double last = std::acos(kNeck_mm / kDome_mm);
    for (int i = 0; i <= kSteps; ++i) {
        const double angle = last * i / kSteps;
        nodes.push_back(
            {.radius_mm = kDome_mm * std::cos(angle), .z_mm = kDome_mm * std::sin(angle)});
    }
    nodes.front().slope_rad = 0.0;
    nodes.back().crease = true;
    nodes.back().slope_before_rad = -last;
    nodes.back().slope_rad = 0.0;
    nodes.back().straight = true;
    nodes.push_back({.radius_mm = kNeck_mm, .z_mm = 80.0});
    const RolledMeridian rolled = rolled_meridian(Meridian(nodes), kBall_mm);
    ASSERT_TRUE(rolled.meridian) << rolled.why_not;
    const double ball_z =
        std::sqrt(std::pow(kDome_mm + kBall_mm, 2) - std::pow(kNeck_mm + kBall_mm, 2));
    const double leaves =
        std::asin(ball_z / (kDome_mm + kBall_mm));  // of the dome, from its equator
    const MeridianPlace before = rolled.meridian->at(kDome_mm * leaves - 1e-3);
    const MeridianPlace behind = rolled.meridian->at(kDome_mm * leaves + 1e-3);
    EXPECT_NEAR(before.curvature_per_mm, 1.0 / kDome_mm, 1e-4);
    EXPECT_NEAR(behind.curvature_per_mm, -1.0 / kBall_mm, 1e-4);
    EXPECT_NEAR(before.slope_rad, behind.slope_rad, 1e-3);
    EXPECT_TRUE(rolled.meridian->creases_mm().empty());
    EXPECT_NEAR(rolled.meridian->length_mm(), kDome_mm * leaves + kBall_mm * leaves + 80.0 - ball_z,
                1e-4);
}

TEST(RolledMeridian, LeavesAloneWhatItTouchesEverywhere) {
    const RolledMeridian convex =
        rolled_meridian(polygon({{10.0, 0.0}, {30.0, 20.0}, {30.0, 50.0}, {10.0, 70.0}}), 5.0);
    EXPECT_FALSE(convex.meridian);
    EXPECT_TRUE(convex.why_not.empty());
    EXPECT_EQ(convex.area_mm2, 0.0);
}

TEST(RolledMeridian, DoesNotRollOffAnEnd) {
    const RolledMeridian rolled = rolled_meridian(shouldered(5.0), 6.0);
    EXPECT_FALSE(rolled.meridian);
    EXPECT_NE(rolled.why_not.find("lower end"), std::string::npos);
}

// Steps, grooves and cones at random: the ball touches all of what comes of it without dipping into
// the body, and what it touched before is still there.
TEST(RolledMeridian, IsWhatABallTouches) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    int filled = 0;
    for (int round = 0; round < 40; ++round) {
        const double ball_mm = 2.0 + 10.0 * share(random);
        std::vector<Vector2d> nodes{{20.0, -40.0}, {20.0, 0.0}};
        for (int i = 0; i < 5; ++i) {
            const Vector2d last = nodes.back();
            const bool step = share(random) < 0.4;
            nodes.emplace_back(15.0 + 20.0 * share(random),
                               last.y() + (step ? 0.0 : 2.0 + 15.0 * share(random)));
        }
        nodes.push_back(nodes.back() + Vector2d(0.0, 40.0));
        const Meridian body = polygon(nodes);
        const RolledMeridian rolled = rolled_meridian(body, ball_mm);
        if (!rolled.meridian) {
            continue;
        }
        ++filled;
        EXPECT_GT(rolled.volume_mm3, 0.0);
        const Meridian& meridian = *rolled.meridian;
        for (int i = 0; i <= 500; ++i) {
            const MeridianPlace at = meridian.at(meridian.length_mm() * i / 500.0);
            const Vector2d ball =
                Vector2d(at.radius_mm, at.z_mm) +
                ball_mm * Vector2d(std::cos(at.slope_rad), -std::sin(at.slope_rad));
            EXPECT_GT(meridian.foot(ball.x(), ball.y()).distance_mm, ball_mm * (1.0 - 1e-4));
            EXPECT_GT(body.foot(ball.x(), ball.y()).distance_mm, ball_mm * (1.0 - 1e-4));
            const MeridianPlace was = body.at(body.length_mm() * i / 500.0);
            const Vector2d there(was.radius_mm, was.z_mm);
            const Vector2d touching =
                there + ball_mm * Vector2d(std::cos(was.slope_rad), -std::sin(was.slope_rad));
            if (body.foot(touching.x(), touching.y()).distance_mm > ball_mm * (1.0 - 1e-9)) {
                EXPECT_LT(meridian.foot(there.x(), there.y()).distance_mm, 1e-4);
            }
        }
    }
    EXPECT_GT(filled, 20);
}

}  // namespace
}  // namespace meshwind
