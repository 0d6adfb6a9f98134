#include "geodesic/bridge.h"

#include <gtest/gtest.h>

#include "geodesic/slip_and_bridging.h"
#include "mesh/shapes/make.h"
#include "tests/support/hourglass.h"
#include "tests/support/reference.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using test::Hourglass;

// The patches' normals, of fourth order: (1.5 / 25)^4 is 1.3e-5 rad. Over the shoulders' curvature
// of 0.04 / mm the place where the fibre touches is out by 3e-4 mm.
constexpr double kNormal_rad = 2e-5;
constexpr double kTouch_mm = 5e-4;

// The wall ahead is looked at every 0.75 mm. Half of that beside its highest place it stands lower
// by (0.75 / 2)^2 / (2 x 25 mm), 2.8e-3 mm: so far, 1.2e-4 rad over the 24 mm to there, a fibre may
// point under it before the bridge is seen, which puts off leaving by 25 mm times that.
constexpr double kUnseen_rad = 1.2e-4;
constexpr double kLeaving_mm = 25.0 * kUnseen_rad + kTouch_mm;

const Surface& hourglass() {
    static const Surface kSurface = Hourglass{}.surface(1.5);
    return kSurface;
}

// On the lower shoulder, `angle` from the meridian.
struct Start {
    SurfacePoint at;
    Vector3d direction;
};

Start start_of(double z_mm, double angle_rad) {
    const Eigen::Vector2d profile = Hourglass{}.point(z_mm);
    const Vector3d p(profile.x(), 0.0, z_mm);
    const Vector3d n = Hourglass{}.normal(p);
    const Vector3d around = Vector3d::UnitY();
    return {test::patch_point(hourglass(), p),
            std::cos(angle_rad) * n.cross(around) + std::sin(angle_rad) * around};
}

// The stations around the stretch in the air.
struct Stretch {
    std::size_t leaving, landing;
};

Stretch bridge_in(const SurfacePath& path, const TautString& string) {
    std::size_t i = string.worst_station;
    std::size_t j = i;
    while (i > 0 && string.gap_mm[i] > 0.0) {
        --i;
    }
    while (j + 1 < path.size() && string.gap_mm[j] > 0.0) {
        ++j;
    }
    return {i, j};
}

TraceResult taut_path(double angle_deg, double length_mm = 70.0) {
    const Start start = start_of(-25.0, rad_from_deg(angle_deg));
    return trace_taut(hourglass(), start.at, start.direction, {}, {.max_length_mm = length_mm});
}

TEST(BridgeAhead, MeridianTouchesAlongTheCommonTangent) {
    const Hourglass shape;
    const Start start = start_of(-shape.height_mm, 0.0);
    const auto bridge = bridge_ahead(
        hourglass(), FieldWalker(hourglass(), start.at),
        // Lowered, so that the far shoulder is seen over it.
        (start.direction - Vector3d(2.0 * kUnseen_rad, 0.0, 0.0)).normalized(), kBridgeReach_mm);
    ASSERT_TRUE(bridge);
    EXPECT_NEAR(bridge->far.position_mm().z(), shape.height_mm, kTouch_mm);
    EXPECT_NEAR(bridge->far.position_mm().x(), shape.line_mm(), 1e-5);
    ASSERT_EQ(bridge->gap_mm.size(), bridge->under.size());
    EXPECT_EQ(bridge->gap_mm.back(), 0.0);
    double s_mm = 0.0;
    for (std::size_t i = 0; i < bridge->under.size(); ++i) {
        const PathPoint& station = bridge->under[i];
        EXPECT_GE(station.s_mm, s_mm);
        s_mm = station.s_mm;
        // Where shoulder and waist meet, the fits of degree four are 5e-3 mm off: half the jump of
        // curvature, 0.08 / mm, over the square of a quarter of their reach of some mm.
        const double below_mm = shape.line_mm() - shape.point(station.position_mm.z()).x();
        EXPECT_NEAR(bridge->gap_mm[i],
                    below_mm * shape.normal(station.position_mm).head<2>().norm(), 0.01);
    }
}

TEST(BridgeAhead, NothingWhereTheWallStaysBelowOrTheReachIsTooShort) {
    const FieldWalker from(hourglass(), start_of(-12.0, 0.0).at);
    const Vector3d raised = Vector3d(1e-3, 0.0, 1.0).normalized();
    const Vector3d lowered = Vector3d(-1e-3, 0.0, 1.0).normalized();
    EXPECT_FALSE(bridge_ahead(hourglass(), from, raised, kBridgeReach_mm));
    EXPECT_TRUE(bridge_ahead(hourglass(), from, lowered, kBridgeReach_mm));
    EXPECT_FALSE(bridge_ahead(hourglass(), from, lowered, 20.0));
}

TEST(BridgeAhead, IsTheSameWhereALiftedWallTellsThatThereIsNone) {
    const LiftedWall lifted(hourglass());
    int bridges = 0;
    int none = 0;
    for (double z_mm = -23.3; z_mm < 24.0; z_mm += 3.1) {
        for (double angle_deg = 0.0; angle_deg < 90.0; angle_deg += 5.0) {
            const Start start = start_of(z_mm, rad_from_deg(angle_deg));
            const FieldWalker from(hourglass(), start.at);
            const auto walked = bridge_ahead(hourglass(), from, start.direction, kBridgeReach_mm);
            const auto told =
                bridge_ahead(hourglass(), from, start.direction, kBridgeReach_mm, &lifted);
            ASSERT_EQ(walked.has_value(), told.has_value());
            (walked ? bridges : none) += 1;
            if (walked) {
                EXPECT_EQ(walked->far.position_mm(), told->far.position_mm());
            }
        }
    }
    EXPECT_GT(bridges, 20);
    EXPECT_GT(none, 20);
}

TEST(TraceTaut, MeridianLeavesAndLandsWhereTheCommonTangentTouches) {
    const Hourglass shape;
    const TraceResult taut = taut_path(0.0);
    const TautString string = taut_string(taut.path);
    const auto [leaving, landing] = bridge_in(taut.path, string);
    EXPECT_NEAR(taut.path[leaving].position_mm.z(), -shape.height_mm, kLeaving_mm);
    EXPECT_NEAR(taut.path[landing].position_mm.z(), shape.height_mm, kLeaving_mm);
    // theta^2 / 4 of itself for the string that turns by 14 deg (slip_and_bridging.h), and 1e-3 by
    // which the station nearest to the middle may miss it.
    EXPECT_NEAR(string.worst_gap_mm, shape.gap_mm(), 0.016 * shape.gap_mm());
    EXPECT_EQ(taut.stop, TraceStop::Rim);
}

TEST(TraceTaut, StraightPartIsTangentToTheSurfaceAtBothEnds) {
    const Hourglass shape;
    for (const double angle_deg : {0.0, 20.0, 45.0}) {
        const TraceResult taut = taut_path(angle_deg);
        const auto [leaving, landing] = bridge_in(taut.path, taut_string(taut.path));
        const PathPoint& from = taut.path[leaving];
        const PathPoint& to = taut.path[landing];
        const Vector3d chord = (to.position_mm - from.position_mm).normalized();
        EXPECT_GT((to.position_mm - from.position_mm).norm(), 15.0);
        EXPECT_NEAR(shape.normal(from.position_mm).dot(chord), 0.0, kUnseen_rad) << angle_deg;
        EXPECT_NEAR(shape.normal(to.position_mm).dot(chord), 0.0, kNormal_rad) << angle_deg;
        // It leaves and arrives in its own direction.
        EXPECT_NEAR(from.tangent.cross(chord).norm(), 0.0, kUnseen_rad) << angle_deg;
        EXPECT_NEAR(to.tangent.cross(chord).norm(), 0.0, kNormal_rad) << angle_deg;
    }
}

// Under a bridge some stations look along the fibre and some along the line below it. That turns
// aside by the gap times the twist of the wall along the fibre, sin cos of the angle times the
// difference of curvatures 0.04 + 1 / 63 per mm: 0.026 rad at 20 deg, where the gap is 1.46 mm.
TEST(TraceTaut, IsContinuousInPlaceAndDirection) {
    constexpr double kAside_rad = 0.03;
    for (const double angle_deg : {0.0, 20.0, 45.0}) {
        const SurfacePath path = taut_path(angle_deg).path;
        const TautString string = taut_string(path);
        for (std::size_t i = 1; i < path.size(); ++i) {
            const double ds = path[i].s_mm - path[i - 1].s_mm;
            ASSERT_GE(ds, 0.0);
            ASSERT_LE((path[i].position_mm - path[i - 1].position_mm).norm(), ds + 1e-9);
            // Curvature along the path is at most 0.05 / mm where the fits round the joint off.
            const double turn = path[i].tangent.cross(path[i - 1].tangent).norm();
            ASSERT_LE(turn, 0.06 * ds + (string.gap_mm[i] > 0.0 ? kAside_rad : 1e-3)) << i;
        }
    }
}

// The way back over the bridge is the same bridge.
TEST(TraceTaut, GivesTheSameWayBackwards) {
    const TraceResult there = taut_path(30.0, 55.0);
    const PathPoint& end = there.path.back();
    const TraceResult back =
        trace_taut(hourglass(), end.at, -end.tangent, {}, {.max_length_mm = end.s_mm});
    EXPECT_LT((back.path.back().position_mm - there.path.front().position_mm).norm(), 2e-3);
}

TEST(TraceTaut, IsTheTraceItselfWhereNothingIsHollow) {
    const Surface tube = test::frozen(make_cylinder({.radius_mm = 40.0, .length_mm = 200.0},
                                                    {.edge_mm = 6.0, .irregular = true}));
    const TraceOptions options{.max_length_mm = 150.0, .method = TraceMethod::Patches};
    const Vector3d direction(0.2, 0.5, 0.4);
    const TraceResult taut = trace_taut(tube, {100}, direction, {0.1, 0.0}, options);
    const TraceResult plain = trace(tube, {100}, direction, {0.1, 0.0}, options);
    ASSERT_EQ(taut.path.size(), plain.path.size());
    EXPECT_EQ(taut.path.back().position_mm, plain.path.back().position_mm);
}

}  // namespace
}  // namespace meshwind
