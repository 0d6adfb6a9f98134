#include "winding/revolution/meridian_path.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "winding/turn/turn.h"

namespace meshwind {
namespace {

// Runge-Kutta steps of 0.25 mm on bodies of 50 mm and splines through nodes every 2 deg.
constexpr double kStep = 1e-9;
constexpr double kSpline = 1e-7;

Meridian cylinder(double radius_mm, double length_mm) {
    return Meridian({{.radius_mm = radius_mm, .z_mm = 0.0, .straight = true},
                     {.radius_mm = radius_mm, .z_mm = length_mm}});
}

// From 1 deg over the lower pole to 1 deg under the upper one.
Meridian sphere(double radius_mm) {
    std::vector<MeridianNode> nodes;
    for (double polar = 1.0; polar <= 179.0; polar += 1.0) {
        const double a = rad_from_deg(polar);
        MeridianNode node{.radius_mm = radius_mm * std::sin(a), .z_mm = -radius_mm * std::cos(a)};
        if (polar == 1.0 || polar == 179.0) {
            node.slope_rad = 0.5 * kPi - a;
        }
        nodes.push_back(node);
    }
    return Meridian(std::move(nodes));
}

TEST(MeridianPath, HelixOnACylinder) {
    const double beta = rad_from_deg(30.0);
    const MeridianPass pass = pass_through(cylinder(40.0, 251.0), 100.0, beta, 0.0, 4.0, 1e4);
    EXPECT_EQ(pass.lower, MeridianStop::End);
    EXPECT_EQ(pass.upper, MeridianStop::End);
    EXPECT_NEAR(pass.length_mm(), 251.0 / std::cos(beta), kStep);
    EXPECT_NEAR(pass.turn_rad(), 251.0 * std::tan(beta) / 40.0, kStep);
    for (const MeridianStation& station : pass.stations) {
        EXPECT_NEAR(station.angle_rad, beta, 1e-12);
        EXPECT_NEAR(station.s_mm * std::cos(beta), station.arc_mm, kStep);
    }
}

// d(1 / sin beta) / dz = -slip / R: hoop after the run that turns take (andrianov_2020, eq. 1).
TEST(MeridianPath, ConstantSlipOnACylinderTurnsAfterTheRunOfTheClosedForm) {
    const double beta = rad_from_deg(45.0);
    const double slip = 0.2;
    const double run = turn_run_mm(40.0, beta, slip);
    // kg < 0 turns to the right: towards growing azimuth.
    const MeridianPass pass = pass_through(cylinder(40.0, 400.0), 200.0, beta, -slip, 4.0, 1e4);
    EXPECT_EQ(pass.upper, MeridianStop::Hoop);
    EXPECT_NEAR(pass.stations.back().arc_mm, 200.0 + run, kStep);
    EXPECT_NEAR(run, 82.84271247461903, 1e-9);  // seed001, Table 3
    const auto start = std::find_if(pass.stations.begin(), pass.stations.end(),
                                    [](const auto& s) { return s.arc_mm >= 200.0; });
    EXPECT_NEAR(deg_from_rad(pass.stations.back().azimuth_rad - start->azimuth_rad),
                252.4949335526311, 1e-7);  // seed001, Table 3
    EXPECT_NEAR(pass.stations.back().s_mm - start->s_mm, 200.0, kStep);
}

TEST(MeridianPath, GreatCirclesOnASphere) {
    for (const double angle_deg : {10.0, 35.0, 80.0}) {
        const double beta = rad_from_deg(angle_deg);
        const Meridian meridian = sphere(50.0);
        const MeridianPass pass =
            pass_through(meridian, 0.5 * meridian.length_mm(), beta, 0.0, 4.0, 1e4);
        EXPECT_EQ(pass.lower, MeridianStop::Hoop) << angle_deg;
        EXPECT_EQ(pass.upper, MeridianStop::Hoop) << angle_deg;
        EXPECT_NEAR(pass.turn_rad(), kPi, 50.0 * kSpline) << angle_deg;
        EXPECT_NEAR(pass.length_mm(), 50.0 * kPi, 50.0 * kSpline) << angle_deg;
        for (const MeridianStation& station : pass.stations) {
            EXPECT_NEAR(station.place.radius_mm * std::sin(station.angle_rad),
                        50.0 * std::sin(beta), 50.0 * kSpline);
        }
    }
}

// A cone unrolls to a plane, in which geodesics are straight.
TEST(MeridianPath, GeodesicOnAConeIsStraightWhenItIsUnrolled) {
    const double half_rad = rad_from_deg(20.0);
    const double length_mm = 100.0;
    const Meridian cone({{.radius_mm = 60.0, .z_mm = 0.0, .straight = true},
                         {.radius_mm = 60.0 - length_mm * std::sin(half_rad),
                          .z_mm = length_mm * std::cos(half_rad)}});
    const double beta = rad_from_deg(20.0);
    // Slant distance from the tip.
    const double start = 60.0 / std::sin(half_rad);
    const MeridianPass pass = pass_through(cone, 0.0, beta, 0.0, 4.0, 1e4);
    ASSERT_EQ(pass.upper, MeridianStop::End);
    for (const MeridianStation& station : pass.stations) {
        const double slant = start - station.arc_mm;
        const double unrolled = station.azimuth_rad * std::sin(half_rad);
        // The straight line that leaves the start at beta to the line towards the tip.
        EXPECT_NEAR(slant * std::sin(beta + unrolled), start * std::sin(beta), start * kStep);
    }
}

// r sin(angle) goes on over a sharp edge, and there are two stations on it.
TEST(MeridianPath, GoesOverACrease) {
    const Meridian body({{.radius_mm = 60.0, .z_mm = 0.0, .straight = true},
                         {.radius_mm = 60.0, .z_mm = 100.0, .crease = true, .straight = true},
                         {.radius_mm = 40.0, .z_mm = 150.0}});
    ASSERT_EQ(body.creases_mm().size(), 1U);
    const double beta = rad_from_deg(30.0);
    for (const double arc : {50.0, 100.0, 120.0}) {
        const double angle = std::asin(60.0 * std::sin(beta) / body.at(arc).radius_mm);
        const MeridianPass pass = pass_through(body, arc, angle, 0.0, 4.0, 1e4);
        std::vector<MeridianStation> on_edge;
        for (const MeridianStation& station : pass.stations) {
            EXPECT_NEAR(station.place.radius_mm * std::sin(station.angle_rad),
                        60.0 * std::sin(beta), 60.0 * kStep);
            if (station.arc_mm == 100.0) {
                on_edge.push_back(station);
            }
        }
        ASSERT_EQ(on_edge.size(), 2U) << arc;
        EXPECT_EQ(on_edge[0].place.slope_rad, 0.0);
        EXPECT_NEAR(on_edge[1].place.slope_rad, -std::atan(0.4), 1e-12);
    }
}

TEST(MeridianPath, TheWayBackMirrorsTheWayUp) {
    const MeridianPass pass = pass_through(sphere(50.0), 60.0, rad_from_deg(25.0), 0.1, 4.0, 1e4);
    const std::vector<MeridianStation> back = way_back(pass);
    EXPECT_EQ(back.front().azimuth_rad, 0.0);
    EXPECT_EQ(back.front().s_mm, 0.0);
    EXPECT_NEAR(back.back().azimuth_rad, pass.turn_rad(), 1e-12);
    EXPECT_NEAR(back.back().s_mm, pass.length_mm(), 1e-9);
    // Tangents are those of the positions.
    for (std::size_t i = 1; i + 1 < back.size(); ++i) {
        const PathPoint before = swept(back[i - 1], 0.3);
        const PathPoint at = swept(back[i], 0.3);
        const PathPoint after = swept(back[i + 1], 0.3);
        EXPECT_LT((after.position_mm - before.position_mm).normalized().cross(at.tangent).norm(),
                  0.05);
        EXPECT_GT((after.position_mm - before.position_mm).dot(at.tangent), 0.0);
        EXPECT_NEAR(at.normal.dot(at.tangent), 0.0, 1e-12);
    }
}

TEST(MeridianPath, KgIsToTheLeftSeenFromOutside) {
    const double slip = 0.15;
    const MeridianPass pass =
        pass_through(cylinder(40.0, 300.0), 150.0, rad_from_deg(50.0), slip, 1.0, 1e4);
    for (std::size_t i = 1; i + 1 < pass.stations.size(); ++i) {
        const PathPoint a = swept(pass.stations[i - 1], 0.0);
        const PathPoint b = swept(pass.stations[i], 0.0);
        const PathPoint c = swept(pass.stations[i + 1], 0.0);
        if (c.s_mm - b.s_mm < 0.99 || b.s_mm - a.s_mm < 0.99) {
            continue;
        }
        const Eigen::Vector3d bend = (c.position_mm - b.position_mm) / (c.s_mm - b.s_mm) -
                                     (b.position_mm - a.position_mm) / (b.s_mm - a.s_mm);
        const double kg = bend.dot(b.normal.cross(b.tangent)) / (0.5 * (c.s_mm - a.s_mm));
        EXPECT_NEAR(kg / b.kn_per_mm, slip, 1e-3);
    }
}

TEST(MeridianPath, EndsWhereItIsLongEnough) {
    const MeridianPass pass =
        pass_through(cylinder(40.0, 1e4), 5e3, rad_from_deg(89.0), 0.0, 4.0, 1000.0);
    EXPECT_EQ(pass.lower, MeridianStop::Length);
    EXPECT_EQ(pass.upper, MeridianStop::Length);
    EXPECT_NEAR(pass.length_mm(), 2000.0, 1.0);
}

}  // namespace
}  // namespace meshwind
