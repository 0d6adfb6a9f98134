#include "winding/revolution/hollow_rim.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/revolution/revolution.h"
#include "tests/support/fixtures.h"
#include "tests/support/tells.h"
#include "winding/revolution/pattern_plan.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kStation_mm = 4.0;

// Stations 4 mm apart on radii of 50 mm: cubics between them are off by (4 / 50)^4 / 384 of it.
constexpr double kCubic_mm = 1e-5;

Meridian cone(double lower_mm, double upper_mm, double length_mm) {
    return Meridian({{.radius_mm = lower_mm, .z_mm = 0.0, .straight = true},
                     {.radius_mm = upper_mm, .z_mm = length_mm}});
}

// Where the straight fibre over a station is.
Vector3d over(const PathPoint& point, double gap_mm) {
    return point.position_mm + gap_mm * point.normal;
}

// A line in space passes the axis at the radius of the extension, beyond the rim.
void expect_touches_extension(const Vector3d& at, const Vector3d& along, double radius_mm,
                              double beyond_mm) {
    const double share = -at.head<2>().dot(along.head<2>()) / along.head<2>().squaredNorm();
    const Vector3d nearest = at + share * along;
    EXPECT_NEAR(nearest.head<2>().norm(), radius_mm, 1e-6);
    EXPECT_GT(std::abs(nearest.z()), beyond_mm);
}

// On a cone c = r sin(a) stays: with S = c / R the fibre leaves the wall where
// sin(a)^2 = (S^2 - sin(psi)^2) / cos(psi)^2.
TEST(HollowRim, UnsteeredFibreLeavesAConeWhereItsTangentTouchesTheExtension) {
    const Meridian meridian = cone(98.0, 54.0, 120.0);
    const double psi = std::atan2(44.0, 120.0);
    for (const double angle_deg : {20.0, 27.0, 30.0, 32.0}) {
        const double c_mm = 98.0 * std::sin(rad_from_deg(angle_deg));
        MeridianPass pass =
            pass_through(meridian, 0.0, rad_from_deg(angle_deg), 0.0, kStation_mm, 1e4);
        ASSERT_EQ(pass.upper, MeridianStop::End);
        ASSERT_EQ(lift_over_rim(meridian, true, kStation_mm, pass.stations), RimLift::Straight);
        std::size_t leaves = pass.stations.size();
        while (pass.stations[leaves - 1].gap_mm > 0.0) {
            --leaves;
        }
        ASSERT_LT(leaves, pass.stations.size());
        const MeridianStation& at = pass.stations[leaves - 1];
        const double ratio = c_mm / 54.0;
        const double sine =
            std::sqrt(ratio * ratio - std::sin(psi) * std::sin(psi)) / std::cos(psi);
        EXPECT_NEAR(at.place.radius_mm, c_mm / sine, kCubic_mm);
        const PathPoint from = swept(at, 0.0);
        expect_touches_extension(from.position_mm, from.tangent, 54.0, 120.0);
        // The stations beyond lie below that line, and so does their direction.
        for (std::size_t i = leaves; i < pass.stations.size(); ++i) {
            const MeridianStation& below = pass.stations[i];
            const PathPoint point = swept(below, 0.0);
            const double along_mm = below.s_mm - at.s_mm;
            const Vector3d line = from.position_mm + along_mm * from.tangent;
            EXPECT_NEAR((line - point.position_mm).dot(point.normal), below.gap_mm, 1e-9);
            const Vector3d fibre = (point.tangent + below.slope * point.normal).normalized();
            EXPECT_NEAR((fibre - from.tangent).norm(), 0.0, 1e-9);
        }
        EXPECT_DOUBLE_EQ(pass.stations.back().arc_mm, meridian.length_mm());
    }
}

TEST(HollowRim, BothEndsAreMirrored) {
    const Meridian up = cone(80.0, 50.0, 100.0);
    const Meridian down = cone(50.0, 80.0, 100.0);
    const double angle = rad_from_deg(28.0);
    for (const double slip : {0.0, 0.1, -0.1}) {
        MeridianPass narrow_above = pass_through(up, 0.0, angle, slip, kStation_mm, 1e4);
        MeridianPass narrow_below =
            pass_through(down, down.length_mm(), angle, -slip, kStation_mm, 1e4);
        ASSERT_EQ(lift_over_rim(up, true, kStation_mm, narrow_above.stations), RimLift::Straight);
        ASSERT_EQ(lift_over_rim(down, false, kStation_mm, narrow_below.stations),
                  RimLift::Straight);
        ASSERT_EQ(narrow_above.stations.size(), narrow_below.stations.size());
        EXPECT_NEAR(narrow_above.turn_rad(), narrow_below.turn_rad(), 1e-9);
        EXPECT_NEAR(narrow_above.length_mm(), narrow_below.length_mm(), 1e-7);
        EXPECT_NEAR(narrow_above.stations.back().gap_mm, narrow_below.stations.front().gap_mm,
                    1e-9);
        EXPECT_NEAR(narrow_above.stations.back().slope, -narrow_below.stations.front().slope, 1e-9);
        EXPECT_DOUBLE_EQ(narrow_below.stations.front().s_mm, 0.0);
    }
}

TEST(HollowRim, StraightAndConvexRimsLeaveThePassAsItIs) {
    for (const Meridian& meridian : {cone(50.0, 50.0, 100.0), cone(50.0, 70.0, 100.0)}) {
        const MeridianPass pass =
            pass_through(meridian, meridian.widest_mm(), rad_from_deg(30.0), 0.0, kStation_mm, 1e4);
        std::vector<MeridianStation> stations = pass.stations;
        EXPECT_EQ(lift_over_rim(meridian, true, kStation_mm, stations), RimLift::OnWall);
        ASSERT_EQ(stations.size(), pass.stations.size());
        for (std::size_t i = 0; i < stations.size(); ++i) {
            EXPECT_EQ(stations[i].s_mm, pass.stations[i].s_mm);
            EXPECT_EQ(stations[i].azimuth_rad, pass.stations[i].azimuth_rad);
            EXPECT_EQ(stations[i].gap_mm, 0.0);
        }
    }
}

// Every tangent passes nearer to the spindle than the extension: S < sin(psi).
TEST(HollowRim, SteepFibreOnASteepConeIsNeverOnTheWall) {
    const Meridian meridian = cone(80.0, 40.0, 40.0);
    MeridianPass pass = pass_through(meridian, 0.0, rad_from_deg(5.0), 0.0, kStation_mm, 1e4);
    EXPECT_EQ(lift_over_rim(meridian, true, kStation_mm, pass.stations), RimLift::NeverOnWall);
}

struct ConeJob {
    double radius1_mm, radius2_mm, length_mm, edge_mm;
    double angle_rad, friction, extension_mm;
};

Plan planned(const ConeJob& job) {
    const Mandrel mandrel = test::made(
        "cone",
        {{"radius1", job.radius1_mm}, {"radius2", job.radius2_mm}, {"length", job.length_mm}},
        job.edge_mm);
    const RevolutionFinding found = find_revolution(mandrel);
    EXPECT_TRUE(found.body.has_value()) << found.why_not;
    PatternOptions options;
    options.angle_rad = job.angle_rad;
    options.tow = {.width_mm = 8.0, .thickness_mm = 0.25, .friction = job.friction};
    options.turn.extension_mm = job.extension_mm;
    return plan_pattern(mandrel, *found.body, options);
}

struct Station {
    PathPoint point;
    double gap_mm;
};

// A plan on a mesh: between leaving one wall and touching the other the fibre is one straight line,
// tangent to the cone at its one end and to the cylinder at the other, across course and turn.
TEST(HollowRim, CourseAirAndTurnAreOneLine) {
    for (const bool up : {true, false}) {
        const Plan plan = planned(
            {up ? 70.0 : 45.0, up ? 45.0 : 70.0, 120.0, 4.0, rad_from_deg(35.0), 0.4, 300.0});
        ASSERT_EQ(plan.failure, "");
        EXPECT_LT(plan.worst_joint_mm, 1e-6);
        EXPECT_LT(plan.pattern()->closure_rad, 1e-6);
        EXPECT_GT(plan.worst_bridge_mm, 0.01);
        std::vector<Station> fibre;
        for (const Piece& piece : plan.pieces) {
            for (std::size_t i = 0; i < piece.path.size(); ++i) {
                fibre.push_back({piece.path[i], piece.string.gap_mm[i]});
            }
        }
        EXPECT_EQ(fibre.front().gap_mm, 0.0);
        EXPECT_EQ(fibre.back().gap_mm, 0.0);
        int bridges = 0;
        for (std::size_t i = 1; i < fibre.size(); ++i) {
            if (fibre[i].gap_mm <= 0.0) {
                continue;
            }
            const PathPoint& from = fibre[i - 1].point;
            std::size_t end = i;
            while (fibre[end].gap_mm > 0.0) {
                ++end;
            }
            const PathPoint& to = fibre[end].point;
            const Vector3d chord = to.position_mm - from.position_mm;
            EXPECT_NEAR(from.tangent.dot(chord.normalized()), 1.0, 1e-9);
            EXPECT_NEAR(to.tangent.dot(chord.normalized()), 1.0, 1e-9);
            for (; i < end; ++i) {
                const Vector3d off = over(fibre[i].point, fibre[i].gap_mm) - from.position_mm;
                // Seen along either wall's normal, at most the kink of 0.2 rad beside it.
                EXPECT_LT(off.cross(chord.normalized()).norm(), 0.25 * fibre[i].gap_mm + 1e-6) << i;
            }
            ++bridges;
        }
        // Each circuit passes the rim out and back; the first is tied on at it where that is below.
        EXPECT_EQ(bridges, plan.courses - (up ? 0 : 1));
    }
}

TEST(HollowRim, MoreThanTheTowMayBridgeIsRefusedInWords) {
    const Plan plan = planned({90.0, 40.0, 80.0, 5.0, rad_from_deg(20.0), 0.5, 1000.0});
    // atan(50 / 80) is the cone's slope.
    EXPECT_TRUE(test::tells(plan.failure, "32.01 deg")) << plan.failure;
    EXPECT_TRUE(plan.pieces.empty());
}

}  // namespace
}  // namespace meshwind
