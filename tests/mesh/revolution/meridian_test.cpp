#include "mesh/revolution/meridian.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "mesh/shapes/profile.h"

namespace meshwind {
namespace {

// Nodes on the circle of this radius about (0, 0) between two angles from the equator.
std::vector<MeridianNode> circle(double radius, double from, double to, int steps, bool slopes) {
    std::vector<MeridianNode> nodes;
    for (int i = 0; i <= steps; ++i) {
        // Uneven, as the rings of a mesh are: every second step is a third longer.
        const double share = (i + (i % 2 == 1 ? 1.0 / 7.0 : 0.0)) / steps;
        const double angle = i == steps ? to : from + (to - from) * share;
        nodes.push_back({radius * std::cos(angle), radius * std::sin(angle)});
        if (slopes && (i == 0 || i == steps)) {
            nodes.back().slope_rad = -angle;
        }
    }
    return nodes;
}

struct Errors {
    double place_mm = 0.0;
    double slope_rad = 0.0;
    double curvature = 0.0;  // share of the right one
    double length_mm = 0.0;
};

// Against the circle itself, place for place at equal arc length.
Errors errors_on_circle(const Meridian& meridian, double radius, double from, double to) {
    Errors worst;
    worst.length_mm = std::abs(meridian.length_mm() - radius * (to - from));
    constexpr int kPlaces = 997;
    for (int i = 0; i <= kPlaces; ++i) {
        const double arc = meridian.length_mm() * i / kPlaces;
        const MeridianPlace place = meridian.at(arc);
        const double angle = from + arc / radius;
        worst.place_mm =
            std::max(worst.place_mm, std::hypot(place.radius_mm - radius * std::cos(angle),
                                                place.z_mm - radius * std::sin(angle)));
        worst.slope_rad = std::max(worst.slope_rad, std::abs(place.slope_rad + angle));
        worst.curvature = std::max(worst.curvature, std::abs(place.curvature_per_mm * radius - 1));
    }
    return worst;
}

TEST(Meridian, CylinderIsExact) {
    const Meridian meridian({{40.0, -125.5}, {40.0, 125.5}});
    EXPECT_EQ(meridian.length_mm(), 251.0);
    EXPECT_TRUE(meridian.creases_mm().empty());
    EXPECT_EQ(meridian.widest_mm(), 125.5);
    for (const double arc : {-1.0, 0.0, 17.3, 251.0, 300.0}) {
        const MeridianPlace place = meridian.at(arc);
        EXPECT_EQ(place.radius_mm, 40.0);
        EXPECT_DOUBLE_EQ(place.z_mm, std::clamp(arc, 0.0, 251.0) - 125.5);
        EXPECT_EQ(place.slope_rad, 0.0);
        EXPECT_EQ(place.curvature_per_mm, 0.0);
    }
}

TEST(Meridian, ConeKeepsItsSlope) {
    // 3-4-5: from radius 60 to 30 over 40 mm of z.
    const Meridian meridian({{60.0, 0.0}, {45.0, 20.0}, {30.0, 40.0}});
    EXPECT_NEAR(meridian.length_mm(), 50.0, 1e-12);
    const MeridianPlace place = meridian.at(10.0);
    EXPECT_NEAR(place.radius_mm, 54.0, 1e-12);
    EXPECT_NEAR(place.z_mm, 8.0, 1e-12);
    EXPECT_NEAR(place.slope_rad, std::atan2(-3.0, 4.0), 1e-15);
    EXPECT_EQ(meridian.widest_mm(), 0.0);
}

// The cubic through h-spaced points: third order in slope, fourth in place, second in curvature.
TEST(Meridian, ArcConvergesAsItsHeaderSays) {
    constexpr double kRadius = 70.0;
    constexpr double kFrom = -0.3;
    constexpr double kTo = 1.2;
    Errors last;
    for (const int steps : {10, 20, 40, 80}) {
        const Meridian meridian(circle(kRadius, kFrom, kTo, steps, true));
        const Errors errors = errors_on_circle(meridian, kRadius, kFrom, kTo);
        const double h =
            8.0 / 7.0 * kRadius * (kTo - kFrom) / steps / kRadius;  // longest, in radii
        // A cubic is off by h^4 / 384 across and its length by h^4 / 720 of the 1.5 radii.
        EXPECT_LT(errors.place_mm, kRadius * std::pow(h, 4) / 200.0);
        EXPECT_LT(errors.slope_rad, std::pow(h, 3) / 50.0);
        EXPECT_LT(errors.curvature, h * h / 6.0);
        if (steps > 10) {
            EXPECT_GT(std::log2(last.place_mm / errors.place_mm), 3.7);
            EXPECT_GT(std::log2(last.slope_rad / errors.slope_rad), 2.7);
            EXPECT_GT(std::log2(last.curvature / errors.curvature), 1.7);
        }
        last = errors;
    }
}

TEST(Meridian, FreeEndsKeepTheOrder) {
    Errors last;
    for (const int steps : {10, 20, 40}) {
        const Errors errors =
            errors_on_circle(Meridian(circle(70.0, -0.3, 1.2, steps, false)), 70.0, -0.3, 1.2);
        if (steps > 10) {
            EXPECT_GT(std::log2(last.place_mm / errors.place_mm), 3.5);
            EXPECT_GT(std::log2(last.slope_rad / errors.slope_rad), 2.5);
        }
        last = errors;
    }
}

TEST(Meridian, PolesAreSmooth) {
    auto nodes = circle(50.0, -0.5 * kPi, 0.5 * kPi, 80, false);
    nodes.front().radius_mm = nodes.back().radius_mm = 0.0;
    const Meridian meridian(nodes);
    EXPECT_DOUBLE_EQ(meridian.at(0.0).slope_rad, 0.5 * kPi);
    EXPECT_DOUBLE_EQ(meridian.at(1e9).slope_rad, -0.5 * kPi);
    EXPECT_EQ(meridian.at(0.0).radius_mm, 0.0);
    // Second derivatives of a cubic spline are off by h^2 / 12, here with h = 0.045 radii.
    EXPECT_NEAR(meridian.at(0.0).curvature_per_mm, 1.0 / 50.0, 2.5e-4 / 50.0);
    EXPECT_NEAR(meridian.length_mm(), 50.0 * kPi, 1e-5);
    EXPECT_NEAR(meridian.widest_mm(), 25.0 * kPi, 1e-4);
}

TEST(Meridian, TipOfAConeIsNoPole) {
    const Meridian meridian({{.radius_mm = 0.0, .z_mm = 0.0, .straight = true},
                             {.radius_mm = 30.0, .z_mm = 40.0, .crease = true},
                             {.radius_mm = 30.0, .z_mm = 90.0}});
    EXPECT_NEAR(meridian.at(0.0).slope_rad, std::atan2(3.0, 4.0), 1e-15);
    ASSERT_EQ(meridian.creases_mm().size(), 1U);
    EXPECT_NEAR(meridian.creases_mm()[0], 50.0, 1e-12);
    EXPECT_EQ(meridian.at(meridian.creases_mm()[0]).slope_rad, 0.0);
    EXPECT_GT(meridian.at(50.0 - 1e-9).slope_rad, 0.6);
    EXPECT_NEAR(meridian.widest_mm(), 75.0, 1e-12);
}

// The vessel's profile: nodes on half ellipses and a cylinder between, nothing said about where
// one ends and the other starts.
TEST(Meridian, CylinderBetweenDomesIsFoundAndExact) {
    const Profile profile = profile_of(VesselShape{});
    std::vector<MeridianNode> nodes;
    for (const ProfilePiece& piece : profile) {
        const int steps = piece.is_line() ? 4 : 40;
        for (int i = nodes.empty() ? 0 : 1; i <= steps; ++i) {
            const Eigen::Vector2d p = piece.point_mm(static_cast<double>(i) / steps);
            nodes.push_back({p.x(), p.y()});
        }
    }
    const Meridian meridian(nodes);
    double length = 0.0;
    for (const ProfilePiece& piece : profile) {
        length += piece.length_mm();
    }
    EXPECT_NEAR(meridian.length_mm(), length, 1e-4);
    EXPECT_NEAR(meridian.widest_mm(), 0.5 * length, 1e-4);
    const double dome = profile[0].length_mm();
    for (const double share : {0.001, 0.3, 0.999}) {
        const MeridianPlace place = meridian.at(dome + share * profile[1].length_mm());
        EXPECT_NEAR(place.radius_mm, 75.0, 1e-12);
        EXPECT_NEAR(place.slope_rad, 0.0, 1e-12);
        EXPECT_EQ(place.curvature_per_mm, 0.0);
    }
    // Just beside the joint the ellipse's own curvature a / b^2, which the cylinder lacks.
    EXPECT_NEAR(meridian.at(dome - 1e-6).curvature_per_mm, 75.0 / (50.0 * 50.0), 1e-4);
    EXPECT_NEAR(meridian.at(dome - 1e-6).slope_rad, 0.0, 1e-6);
}

// A knuckle of radius 10 that goes over into a crown of radius 60 with one tangent.
TEST(Meridian, JointKeepsTheSlopeAndLetsTheCurvatureJump) {
    const auto nodes_of = [](bool joint) {
        std::vector<MeridianNode> nodes;
        const auto arc = [&](double radius, double centre_r, double centre_z, double from,
                             double to, int steps) {
            for (int i = nodes.empty() ? 0 : 1; i <= steps; ++i) {
                const double angle = from + (to - from) * i / steps;
                nodes.push_back(
                    {centre_r + radius * std::cos(angle), centre_z + radius * std::sin(angle)});
            }
        };
        arc(10.0, 40.0, 0.0, 0.0, 0.8, 16);
        nodes.back().joint = joint;
        arc(60.0, 40.0 - 50.0 * std::cos(0.8), -50.0 * std::sin(0.8), 0.8, 1.3, 40);
        return nodes;
    };
    const Meridian with(nodes_of(true));
    EXPECT_NEAR(with.at(8.0 - 1e-4).slope_rad, with.at(8.0 + 1e-4).slope_rad, 1e-4);
    EXPECT_NEAR(with.at(7.99).curvature_per_mm, 0.1, 0.002);
    EXPECT_NEAR(with.at(8.01).curvature_per_mm, 1.0 / 60.0, 0.002);
    const Meridian without(nodes_of(false));
    EXPECT_GT(std::abs(without.at(7.99).curvature_per_mm - 0.1), 0.01);
}

TEST(Meridian, FootIsNearestPlace) {
    const Meridian meridian(circle(70.0, -1.0, 1.0, 60, true));
    for (const double angle : {-0.9, -0.2, 0.55}) {
        const MeridianFoot foot = meridian.foot(73.0 * std::cos(angle), 73.0 * std::sin(angle));
        EXPECT_NEAR(foot.distance_mm, 3.0, 1e-5);
        EXPECT_NEAR(foot.arc_mm, 70.0 * (angle + 1.0), 1e-4);
    }
    const MeridianFoot end = meridian.foot(0.0, 100.0);
    EXPECT_NEAR(end.arc_mm, meridian.length_mm(), 1e-9);
}

TEST(Meridian, FlatAnnulusIsAMeridian) {
    const Meridian meridian({{.radius_mm = 10.0, .z_mm = 5.0}, {.radius_mm = 40.0, .z_mm = 5.0}});
    EXPECT_DOUBLE_EQ(meridian.at(3.0).slope_rad, 0.5 * kPi);
    EXPECT_EQ(meridian.at(3.0).radius_mm, 13.0);
}

TEST(Meridian, RefusesNodesThatAreNone) {
    const auto code = [](std::vector<MeridianNode> nodes) {
        try {
            const Meridian meridian(std::move(nodes));
            return std::string();
        } catch (const InputError& error) {
            return error.code();
        }
    };
    EXPECT_EQ(code({}), "meridian.node");
    EXPECT_EQ(code({{1.0, 0.0}}), "meridian.node");
    EXPECT_EQ(code({{1.0, 0.0}, {1.0, 0.0}}), "meridian.node");
    EXPECT_EQ(code({{1.0, 0.0}, {-1.0, 2.0}}), "meridian.node");
    EXPECT_EQ(code({{1.0, 0.0}, {std::nan(""), 2.0}}), "meridian.node");
    EXPECT_EQ(code({{1.0, 0.0}, {0.0, 1.0}, {1.0, 2.0}}), "meridian.node");
    EXPECT_EQ(code({{0.0, 0.0}, {1.0, 2.0}}), "");
}

}  // namespace
}  // namespace meshwind
