#include "winding/revolution/steered_pass.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"

namespace meshwind {
namespace {

// Runge-Kutta steps of 0.25 mm on straight meridians of 30 to 60 mm.
constexpr double kStep = 1e-9;

// Splines through nodes every degree on 50 mm.
constexpr double kSpline = 1e-5;

constexpr double kRadius = 50.0;

Meridian line(double radius1_mm, double radius2_mm, double length_mm) {
    return Meridian({{.radius_mm = radius1_mm, .z_mm = 0.0, .straight = true},
                     {.radius_mm = radius2_mm, .z_mm = length_mm}});
}

// Half spheres from 1 deg beside the poles on a cylinder; without one a sphere.
Meridian capsule(double cylinder_mm) {
    std::vector<MeridianNode> nodes;
    const auto add = [&](double polar_deg, double z_mm) -> MeridianNode& {
        const double a = rad_from_deg(polar_deg);
        nodes.push_back({.radius_mm = kRadius * std::sin(a), .z_mm = z_mm - kRadius * std::cos(a)});
        nodes.back().slope_rad = 0.5 * kPi - a;
        return nodes.back();
    };
    for (double polar = 1.0; polar < 90.0; polar += 1.0) {
        add(polar, 0.0);
    }
    if (cylinder_mm > 0.0) {
        add(90.0, 0.0).straight = true;
    }
    for (double polar = 90.0; polar <= 179.0; polar += 1.0) {
        add(polar, cylinder_mm);
    }
    return Meridian(std::move(nodes));
}

double turning_mm(const MeridianStation& at) {
    return at.place.radius_mm * std::sin(at.angle_rad);
}

SteeringTask task(double lower_mm, double upper_mm, double most_slip) {
    SteeringTask task;
    task.lower_mm = lower_mm;
    task.upper_mm = upper_mm;
    task.most_slip = most_slip;
    return task;
}

TEST(SteerFrom, OnACylinderTheSinesInverseIsLinear) {
    const Meridian meridian = line(40.0, 40.0, 200.0);
    for (const double slip : {0.0, 0.1, -0.05}) {
        const SteeredEnd end = steer_from(meridian, 20.0, 30.0, slip, 120.0);
        EXPECT_FALSE(end.turned) << slip;
        EXPECT_NEAR(40.0 / end.turning_mm, 40.0 / 30.0 + slip * 100.0 / 40.0, kStep) << slip;
        const SteeredEnd back = steer_from(meridian, 120.0, end.turning_mm, slip, 20.0);
        EXPECT_NEAR(back.turning_mm, 30.0, kStep) << slip;
    }
    // Hoop after the run R / slip (1 / sin a - 1), downward as slip leads to the pole above.
    const SteeredEnd turned = steer_from(meridian, 150.0, 30.0, 0.2, 0.0);
    EXPECT_TRUE(turned.turned);
    EXPECT_NEAR(turned.arc_mm, 150.0 - 40.0 / 0.2 * (40.0 / 30.0 - 1.0), 1e-7);
}

// d(1 / c)/d(1 / r) = slip / t, t = tangent of half the cone's angle.
TEST(SteerFrom, OnAConeTheSinesInverseIsLinearInTheRadius) {
    const Meridian meridian = line(60.0, 30.0, 200.0);
    const double t = 0.15;
    for (const double slip : {0.1, 0.15, 0.19}) {
        const double sine = std::sin(rad_from_deg(60.0));
        const SteeredEnd end =
            steer_from(meridian, 0.0, 60.0 * sine, slip, 0.5 * meridian.length_mm());
        const double share = 45.0 / 60.0;
        EXPECT_NEAR(45.0 / end.turning_mm, share / sine + slip / t * (1.0 - share), kStep) << slip;
    }
    // The ratio that keeps the winding angle.
    const double sine = std::sin(rad_from_deg(70.0));
    const SteeredEnd kept = steer_from(meridian, 0.0, 60.0 * sine, t / sine, meridian.length_mm());
    EXPECT_NEAR(kept.turning_mm / 30.0, sine, kStep);
}

// Without slip the cone is unrolled to a plane and the path a straight line.
TEST(SteerFrom, AGeodesicOnAConeTurnsWhereTheStraightLineIsNearestToTheTip) {
    const Meridian meridian = line(60.0, 30.0, 200.0);
    const double c = 60.0 * std::sin(rad_from_deg(50.0));
    const SteeredEnd end = steer_from(meridian, 0.0, c, 0.0, meridian.length_mm());
    EXPECT_TRUE(end.turned);
    EXPECT_NEAR(end.turning_mm, c, kStep);
    EXPECT_NEAR(meridian.at(end.arc_mm).radius_mm, c, 1e-7);
}

// A taut string over the edge of a cone on a narrower cylinder has no friction to be steered by.
TEST(SteerFrom, BesideAHollowEdgeNothingIsSteered) {
    const Meridian meridian({{.radius_mm = 60.0, .z_mm = 0.0, .straight = true},
                             {.radius_mm = 40.0, .z_mm = 60.0, .straight = true},
                             {.radius_mm = 40.0, .z_mm = 140.0}});
    ASSERT_EQ(meridian.creases_mm().size(), 1U);
    const double crease = meridian.creases_mm()[0];
    const double sine = std::sin(rad_from_deg(60.0));
    const double kink = std::atan2(20.0, 60.0);
    // Along the meridian: on the cylinder kink cos(a)^2 / (2 kn).
    const double half = 0.5 * kink * (1.0 - sine * sine) * 40.0 / (sine * sine);
    const double c = 40.0 * sine;
    const auto after = [&](double arc_mm) {
        return steer_from(meridian, crease, c, 0.15, crease + arc_mm).turning_mm;
    };
    EXPECT_EQ(after(half), c);
    EXPECT_LT(after(2.0 * half), c);
    EXPECT_NEAR(40.0 / after(60.0), 1.0 / sine + 0.15 * (60.0 - 1.5 * half) / 40.0,
                0.15 * 0.25 / 40.0);
}

TEST(NarrowPlace, IsTheNearestToTheWidest) {
    const Meridian sphere = capsule(0.0);
    const auto low = narrow_place_mm(sphere, 25.0, false);
    const auto high = narrow_place_mm(sphere, 25.0, true);
    ASSERT_TRUE(low && high);
    EXPECT_NEAR(*low, kRadius * rad_from_deg(29.0), kSpline);
    EXPECT_NEAR(*high, kRadius * rad_from_deg(149.0), kSpline);
    EXPECT_FALSE(narrow_place_mm(sphere, 0.1, true));
    EXPECT_FALSE(narrow_place_mm(sphere, 60.0, true));
}

// On a sphere kn = 1 / R: paths of constant slip are circles, between latitudes q1 below and q2
// above with slip = tan((q2 - q1) / 2).
TEST(SteerBetween, OnASphereTheSlipHasAClosedForm) {
    const Meridian sphere = capsule(0.0);
    for (const auto& [lower, upper] :
         {std::pair{15.0, 20.0}, std::pair{20.0, 15.0}, std::pair{30.0, 12.0}}) {
        const SteeringFinding finding = steer_between(sphere, task(lower, upper, 0.5));
        ASSERT_TRUE(finding.found);
        const double q1 = std::acos(lower / kRadius);
        const double q2 = std::acos(upper / kRadius);
        EXPECT_NEAR(finding.found->slip_ratio, std::tan(0.5 * (q2 - q1)), 1e-6);
        const MeridianPass& pass = finding.found->pass;
        EXPECT_NEAR(turning_mm(pass.stations.front()), lower, 1e-6);
        EXPECT_NEAR(turning_mm(pass.stations.back()), upper, 1e-6);
        // Half of a circle in a plane that leans.
        const double plane = std::hypot(kRadius * (std::sin(q1) + std::sin(q2)), lower + upper);
        EXPECT_NEAR(pass.length_mm(), 0.5 * kPi * plane, 1e-4);
    }
}

// From the spheres' and the cylinder's laws by halving, without meridians.
double slip_of_capsule(double lower, double upper, double cylinder) {
    const auto above = [&](double slip) {
        const double c = lower - slip * kRadius * std::sin(std::acos(lower / kRadius));
        const double top = 1.0 / (1.0 / c + slip * cylinder / (kRadius * kRadius));
        return top - slip * kRadius * std::sin(std::acos(upper / kRadius)) - upper;
    };
    double low = -0.5;
    double high = 0.5;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (above(middle) > 0.0 ? low : high) = middle;
    }
    return low;
}

TEST(SteerBetween, LeadsOverACylinderFromOneTurnToTheOther) {
    const Meridian meridian = capsule(120.0);
    const SteeringFinding finding = steer_between(meridian, task(18.0, 15.0, 0.2));
    ASSERT_TRUE(finding.found);
    EXPECT_NEAR(finding.found->slip_ratio, slip_of_capsule(18.0, 15.0, 120.0), 1e-4);
    EXPECT_NEAR(turning_mm(finding.found->pass.stations.front()), 18.0, 1e-6);
    EXPECT_NEAR(turning_mm(finding.found->pass.stations.back()), 15.0, 1e-6);
}

TEST(SteerBetween, EqualTurnsTakeNoSlip) {
    const SteeringFinding finding = steer_between(capsule(100.0), task(20.0, 20.0, 0.0));
    ASSERT_TRUE(finding.found);
    EXPECT_EQ(finding.found->slip_ratio, 0.0);
    EXPECT_NEAR(finding.found->angle_rad, std::asin(0.4), kSpline);
}

TEST(SteerBetween, SaysHowFarTheFrictionLeads) {
    const double q1 = std::acos(0.8);
    const SteeringFinding finding = steer_between(capsule(0.0), task(40.0, 10.0, 0.1));
    EXPECT_FALSE(finding.found);
    EXPECT_NEAR(finding.reached_mm, kRadius * std::cos(q1 + 2.0 * std::atan(0.1)), kSpline);
    // The other way, too.
    const SteeringFinding wide = steer_between(capsule(0.0), task(30.0, 45.0, 0.1));
    EXPECT_FALSE(wide.found);
    EXPECT_NEAR(wide.reached_mm, kRadius * std::cos(std::acos(0.6) - 2.0 * std::atan(0.1)),
                kSpline);
    // Nowhere as wide as this.
    EXPECT_FALSE(steer_between(capsule(0.0), task(60.0, 10.0, 0.1)).found);
}

}  // namespace
}  // namespace meshwind
