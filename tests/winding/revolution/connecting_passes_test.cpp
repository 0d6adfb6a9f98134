#include "winding/revolution/connecting_passes.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "core/units.h"

namespace meshwind {
namespace {

using Kind = ConnectingGoal::Kind;

constexpr double kRadius_mm = 50.0;
constexpr double kFriction = 0.2;

// A sphere's zone on either side of a cylinder, nodes every degree.
Meridian capsule(double cylinder_mm) {
    std::vector<MeridianNode> nodes;
    constexpr int kFirst = 75;
    for (int degree = -kFirst; degree <= kFirst; ++degree) {
        const double at = rad_from_deg(degree);
        const auto add = [&](double shift_mm, bool joint, bool straight) {
            nodes.push_back({.radius_mm = kRadius_mm * std::cos(at),
                             .z_mm = kRadius_mm * std::sin(at) + shift_mm,
                             .slope_rad = -at,
                             .joint = joint,
                             .straight = straight});
        };
        if (degree == 0) {
            add(-0.5 * cylinder_mm, true, true);
            add(0.5 * cylinder_mm, true, false);
        } else {
            add(std::copysign(0.5 * cylinder_mm, at), false, false);
        }
    }
    return Meridian(nodes);
}

// Arc at which the radius is so, on the lower dome.
double lower_arc(const Meridian& meridian, double radius_mm) {
    const double low = std::acos(radius_mm / kRadius_mm);
    (void)meridian;
    return kRadius_mm * (rad_from_deg(75.0) - low);
}

ConnectingRequest between(const Meridian& meridian, double from_mm, double to_mm) {
    ConnectingRequest request;
    request.from_arc_mm = lower_arc(meridian, from_mm);
    const double arc = lower_arc(meridian, to_mm);
    request.goal = {ConnectingGoal{Kind::Parallel, arc},
                    ConnectingGoal{Kind::Parallel, meridian.length_mm() - arc}};
    request.friction = kFriction;
    request.can_turn = [](std::size_t, const MeridianStation&) { return false; };
    return request;
}

// r sin(a), by the law, may change by at most friction times the integral of r kn: each pass ends
// where the next begins, and the last at the parallel asked for.
TEST(ConnectingPasses, ArriveAtTheParallel) {
    const Meridian meridian = capsule(120.0);
    for (const double to_mm : {26.0, 33.0, 45.0}) {
        const ConnectingRequest request = between(meridian, 25.0, to_mm);
        const ConnectingPasses way = connecting_passes(meridian, request);
        ASSERT_EQ(way.failure, "");
        ASSERT_FALSE(way.passes.empty());
        const MeridianStation& last = way.passes.back().back();
        EXPECT_NEAR(last.arc_mm, request.goal[way.end].arc_mm, 1e-9);
        EXPECT_NEAR(last.angle_rad, 0.5 * kPi, 1e-6);
        EXPECT_NEAR(way.passes.front().front().arc_mm, request.from_arc_mm, 1e-9);
        for (std::size_t i = 1; i < way.passes.size(); ++i) {
            EXPECT_NEAR(way.passes[i].front().arc_mm, way.passes[i - 1].back().arc_mm, 1e-9);
            EXPECT_EQ(way.passes[i].front().azimuth_rad, way.passes[i - 1].back().azimuth_rad);
        }
        // Along each pass kg / kn is one number within the friction, from the angles themselves.
        for (const auto& pass : way.passes) {
            const double sign = pass.back().arc_mm > pass.front().arc_mm ? 1.0 : -1.0;
            for (std::size_t i = 1; i + 2 < pass.size(); ++i) {
                const MeridianStation& a = pass[i - 1];
                const MeridianStation& b = pass[i + 1];
                const MeridianStation& m = pass[i];
                if (std::abs(a.place.curvature_per_mm - b.place.curvature_per_mm) > 1e-6) {
                    continue;  // over a joint
                }
                const double ds = b.s_mm - a.s_mm;
                const double turn =
                    sign * (b.angle_rad - a.angle_rad) / ds +
                    sign * std::sin(m.place.slope_rad) * std::sin(m.angle_rad) / m.place.radius_mm;
                const double c = std::cos(m.angle_rad);
                const double s = std::sin(m.angle_rad);
                const double kn = m.place.curvature_per_mm * c * c +
                                  std::cos(m.place.slope_rad) * s * s / m.place.radius_mm;
                EXPECT_LT(std::abs(turn), (kFriction + 0.02) * kn);
            }
        }
    }
}

TEST(ConnectingPasses, LittleFrictionTakesMorePasses) {
    const Meridian meridian = capsule(120.0);
    std::size_t before = 0;
    for (const double friction : {0.2, 0.05, 0.02}) {
        ConnectingRequest request = between(meridian, 25.0, 40.0);
        request.friction = friction;
        const ConnectingPasses way = connecting_passes(meridian, request);
        ASSERT_EQ(way.failure, "");
        EXPECT_NEAR(way.passes.back().back().arc_mm, request.goal[way.end].arc_mm, 1e-9);
        EXPECT_GT(way.passes.size(), before);
        before = way.passes.size();
    }
}

// A way back is the same way: same parallels in the opposite order.
TEST(ConnectingPasses, TheOtherWayRound) {
    const Meridian meridian = capsule(120.0);
    const ConnectingPasses way = connecting_passes(meridian, between(meridian, 25.0, 40.0));
    const auto back = other_way_round(way);
    ASSERT_EQ(back.size(), way.passes.size());
    EXPECT_EQ(back.front().front().arc_mm, way.passes.back().back().arc_mm);
    EXPECT_EQ(back.back().back().arc_mm, way.passes.front().front().arc_mm);
    double azimuth = 0.0;
    for (const auto& pass : back) {
        for (const MeridianStation& station : pass) {
            EXPECT_GE(station.azimuth_rad, azimuth - 1e-12);
            azimuth = station.azimuth_rad;
        }
    }
    EXPECT_NEAR(azimuth, way.passes.back().back().azimuth_rad, 1e-9);
}

TEST(ConnectingPasses, NothingToDo) {
    const Meridian meridian = capsule(50.0);
    const ConnectingPasses way = connecting_passes(meridian, between(meridian, 30.0, 30.0));
    EXPECT_TRUE(way.passes.empty());
    EXPECT_EQ(way.end, 0U);
}

// Without friction a fibre on a body of equal ends turns at its own radius for ever.
TEST(ConnectingPasses, SaysWhereItStays) {
    const Meridian meridian = capsule(50.0);
    ConnectingRequest request = between(meridian, 25.0, 35.0);
    request.friction = 1e-6;
    const ConnectingPasses way = connecting_passes(meridian, request);
    EXPECT_NE(way.failure.find("radius 25."), std::string::npos) << way.failure;
}

}  // namespace
}  // namespace meshwind
