#include "winding/revolution/aim_pass.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/revolution/swept_wall.h"
#include "mesh/shapes/make.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

BodyOfRevolution body_of(const TriangleSoup& soup) {
    const RevolutionFinding found = find_revolution(build_mandrel(soup, "made.stl"));
    EXPECT_TRUE(found.body) << found.why_not;
    return *found.body;
}

const BodyOfRevolution& cone() {
    static const BodyOfRevolution kBody = body_of(make_cone({60.0, 30.0, 200.0}));
    return kBody;
}

const BodyOfRevolution& combination() {
    static const BodyOfRevolution kBody = body_of(make_combination({}));
    return kBody;
}

AimTask task(double angle_deg, double most_slip, double touching_mm = 13.0) {
    return {.angle_rad = rad_from_deg(angle_deg),
            .most_slip = most_slip,
            .touching_mm = {touching_mm, touching_mm}};
}

MeridianPass pass_of(const BodyOfRevolution& body, double angle_deg, const HalfSlips& slip) {
    return pass_through(body.meridian, body.meridian.widest_mm(), rad_from_deg(angle_deg), slip,
                        4.0, 1e5);
}

// 1 / sin(70 deg) = share / sin(a) + slip / t (1 - share): the least slip that comes flat enough.
TEST(AimAtEnds, AConeTakesTheSlipOfTheClosedForm) {
    for (const double angle_deg : {50.0, 60.0, 69.0}) {
        const PassAim aim = aim_at_ends(cone(), task(angle_deg, 0.2));
        EXPECT_EQ(aim.failure, "");
        const double rim = 1.0 / std::sin(rad_from_deg(70.0));
        const double slip = 0.15 * (rim - 0.5 / std::sin(rad_from_deg(angle_deg))) / 0.5;
        EXPECT_NEAR(std::abs(aim.slip.above + aim.slip.below), slip, 1e-6) << angle_deg;
        const MeridianPass pass = pass_of(cone(), angle_deg, aim.slip);
        EXPECT_EQ(pass.lower, MeridianStop::End);
        EXPECT_EQ(pass.upper, MeridianStop::End);
        EXPECT_NEAR(
            deg_from_rad(std::max(pass.stations.front().angle_rad, pass.stations.back().angle_rad)),
            70.0, 1e-4);
    }
}

TEST(AimAtEnds, SaysHowFarTheFibreComesAndWhatWouldDo) {
    const PassAim aim = aim_at_ends(cone(), task(55.0, 0.1));
    // Where sin a is 1: share / sin(a) + slip / t (1 - share) = 1.
    const double share = (1.0 - 0.1 / 0.15) / (1.0 / std::sin(rad_from_deg(55.0)) - 0.1 / 0.15);
    EXPECT_TRUE(test::tells(aim.failure, "radius " + fixed(60.0 * share, 1))) << aim.failure;
    EXPECT_TRUE(test::tells(aim.failure, "friction of 0.136")) << aim.failure;
    // sin(a) = 0.5 / (1 / sin(70 deg) - 0.5 * 0.1 / 0.15)
    EXPECT_TRUE(test::tells(aim.failure, "43.2 deg")) << aim.failure;
}

TEST(AimAtEnds, NothingIsSteeredThatNeedsNoSteering) {
    const BodyOfRevolution pipe = body_of(make_cylinder({40.0, 200.0}));
    const BodyOfRevolution vessel = body_of(make_vessel({}));
    for (const double angle_deg : {20.0, 45.0, 85.0}) {
        for (const BodyOfRevolution* body : {&pipe, &vessel}) {
            const PassAim aim = aim_at_ends(*body, task(angle_deg, 0.2));
            EXPECT_EQ(aim.failure, "");
            EXPECT_EQ(aim.slip.below, 0.0) << angle_deg;
            EXPECT_EQ(aim.slip.above, 0.0) << angle_deg;
        }
    }
}

TEST(AimAtEnds, ACombinationIsSteeredAsFarIntoItsDomeAsPossible) {
    const PassAim aim = aim_at_ends(combination(), task(55.0, 0.17));
    EXPECT_EQ(aim.failure, "");
    EXPECT_EQ(aim.slip.below, 0.0);
    EXPECT_EQ(aim.slip.above, 0.17);
    const MeridianPass pass = pass_of(combination(), 55.0, aim.slip);
    EXPECT_EQ(pass.upper, MeridianStop::Hoop);
    EXPECT_GT(pass.stations.back().arc_mm, cap_mm(combination(), 1));
    // With more friction it turns where the band touches the opening.
    const PassAim more = aim_at_ends(combination(), task(55.0, 0.5));
    EXPECT_LT(more.slip.above, 0.5);
    const MeridianPass touching = pass_of(combination(), 55.0, more.slip);
    // Both step over joints and the ends of what is not steered, in steps of 0.25 mm.
    EXPECT_NEAR(touching.stations.back().place.radius_mm, 13.0, 0.05);
}

TEST(CapOf, IsTheDomeOrTheEnd) {
    const Meridian& meridian = combination().meridian;
    EXPECT_EQ(cap_mm(combination(), 0), 0.0);
    EXPECT_NEAR(meridian.at(cap_mm(combination(), 1)).radius_mm, 40.0, 1e-3);
    EXPECT_EQ(cap_mm(cone(), 0), 0.0);
    EXPECT_EQ(cap_mm(cone(), 1), cone().meridian.length_mm());
}

// A pipe of radius 60, a cone, and a pipe of radius 40 behind it, where fibre comes flatter with
// each turn: steepest it is at the corner. Per mm of the wide pipe 1 / sin(a) grows by slip / R; on
// the cone it is linear in the radius; beside the corner, over which the fibre hangs, nothing is
// steered.
const BodyOfRevolution& reducer() {
    static const BodyOfRevolution kBody =
        body_of(swept_wall(Meridian({{.radius_mm = 60.0, .z_mm = -50.0, .straight = true},
                                     {.radius_mm = 60.0, .z_mm = 50.0, .straight = true},
                                     {.radius_mm = 40.0, .z_mm = 110.0, .straight = true},
                                     {.radius_mm = 40.0, .z_mm = 310.0}}),
                           300.0)
                    .soup);
    return kBody;
}

double steepest_deg(const MeridianPass& pass) {
    double most = 0.0;
    for (const MeridianStation& station : pass.stations) {
        most = std::max(most, station.angle_rad);
    }
    return deg_from_rad(most);
}

// An isotensoid turns back near the radius that its fibres turn at: its lip is hollow, and fibres
// that turn on the dome do not come there.
TEST(AimAtEnds, AHollowLipOfADomeIsPartOfItsCap) {
    const BodyOfRevolution body = body_of(
        make_isotensoid({.radius_mm = 40.0, .cylinder_length_mm = 80.0, .opening_radius_mm = 15.0},
                        {.edge_mm = 2.0}));
    ASSERT_LT(body.meridian.at(0.0).curvature_per_mm, 0.0);
    EXPECT_NE(cap_mm(body, 0), 0.0);
    EXPECT_NE(cap_mm(body, 1), body.meridian.length_mm());
    for (const double angle_deg : {30.0, 40.0, 55.0}) {
        SCOPED_TRACE(angle_deg);
        const PassAim aim = aim_at_ends(body, task(angle_deg, 0.17, 18.0));
        EXPECT_EQ(aim.failure, "");
        // No nearer to the opening than the band's touching it.
        const MeridianPass pass = pass_of(body, angle_deg, aim.slip);
        EXPECT_GT(pass.stations.front().place.radius_mm, 18.0 - 0.1);
        EXPECT_LT(pass.stations.front().place.radius_mm,
                  40.0 * std::sin(rad_from_deg(angle_deg)) + 0.1);
    }
}

TEST(AimAtEnds, KeepsFlatAtTheCornerOfANarrowPipe) {
    const PassAim aim = aim_at_ends(reducer(), task(40.0, 0.2));
    EXPECT_EQ(aim.failure, "");
    const double slip =
        (1.0 / std::sin(rad_from_deg(70.0)) - 2.0 / 3.0 / std::sin(rad_from_deg(40.0))) /
        (2.0 / 3.0 * 50.0 / 60.0 + 1.0);
    EXPECT_NEAR(aim.slip.above, slip, 0.05 * slip);
    EXPECT_NEAR(steepest_deg(pass_of(reducer(), 40.0, aim.slip)), 70.0, 0.1);
}

// With half of the friction that it takes, and all of it used, the rim is still reached flat
// enough.
TEST(AimAtEnds, CrossesACornerSteeperForWantOfFriction) {
    const double enough = aim_at_ends(reducer(), task(40.0, 0.2)).slip.above;
    const PassAim aim = aim_at_ends(reducer(), task(40.0, 0.5 * enough));
    EXPECT_EQ(aim.failure, "");
    EXPECT_EQ(aim.slip.above, 0.5 * enough);
    const MeridianPass pass = pass_of(reducer(), 40.0, aim.slip);
    EXPECT_EQ(pass.upper, MeridianStop::End);
    EXPECT_GT(steepest_deg(pass), 71.0);
    EXPECT_LT(steepest_deg(pass), 85.0);
    EXPECT_LT(deg_from_rad(pass.stations.back().angle_rad), 70.0);
}

}  // namespace
}  // namespace meshwind
