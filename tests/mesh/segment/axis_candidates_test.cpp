#include "mesh/segment/axis_candidates.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/shapes/make.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kEdge_mm = 6.0;

std::vector<AxisCandidate> candidates(const TriangleSoup& soup, const MandrelOptions& options) {
    return axis_candidates(build_mandrel(soup, "part.stl", options));
}

std::vector<AxisCandidate> candidates(const TriangleSoup& soup) {
    return candidates(soup, {.unit_mm = 1.0});
}

const AxisCandidate* find(const std::vector<AxisCandidate>& list, const std::string& rule) {
    const auto found = std::find_if(list.begin(), list.end(),
                                    [&](const AxisCandidate& c) { return c.rule == rule; });
    return found == list.end() ? nullptr : &*found;
}

// Vertices lie on the ideal pipe. About its axis they swing by the radius, about a line square to
// it through the middle by the corner's distance; the axis of revolution is the same line and does
// not stand twice.
TEST(AxisCandidates, OfAPipeAreItsAxisAndTwoSquareToIt) {
    const auto found =
        candidates(make_cylinder({.radius_mm = 30.0, .length_mm = 120.0}, {.edge_mm = kEdge_mm}));
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0].rule, "coaxial-rims");
    EXPECT_EQ(found[0].rims, 2);
    EXPECT_NEAR(found[0].swing_mm, 30.0, 1e-9);
    for (std::size_t i = 1; i < 3; ++i) {
        EXPECT_EQ(found[i].rule, "principal");
        EXPECT_EQ(found[i].rims, 0);
        EXPECT_NEAR(found[i].angle_rad, 0.5 * kPi, 1e-6);
        // Up to half an edge around beside the farthest place.
        EXPECT_NEAR(found[i].swing_mm, std::hypot(60.0, 30.0), 0.2);
    }
}

TEST(AxisCandidates, OfATeeTheRunIsChosen) {
    const TeeShape tee;
    const auto found = candidates(make_tee(tee, {.edge_mm = 8.0}));
    EXPECT_EQ(found[0].rule, "coaxial-rims");
    EXPECT_EQ(found[0].rims, 2);
    EXPECT_NEAR(found[0].swing_mm, std::hypot(tee.branch_length_mm, tee.branch_radius_mm), 0.1);
    const AxisCandidate* revolution = find(found, "revolution");
    ASSERT_NE(revolution, nullptr);
    EXPECT_NE(revolution->why.find("miss it by"), std::string::npos) << revolution->why;
    EXPECT_EQ(find(found, "chord"), nullptr);
}

// A bend without legs is a quarter of a torus: three quarters about the torus' axis are open, and
// the outermost place of it is the pipe's radius beyond the bend's. Normals at the two cuts are
// one-sided, by half an edge: what that pulls the axis goes with its square, as the cuts' share of
// the wall goes with the edge as well.
TEST(AxisCandidates, OfABendTheAxisOfItsTorusIsOpen) {
    const ElbowShape bend{.leg1_mm = 0.0, .leg2_mm = 0.0};
    std::vector<double> off_mm;
    for (const double edge_mm : {6.0, 3.0}) {
        const auto found = candidates(make_elbow(bend, {.edge_mm = edge_mm}));
        EXPECT_EQ(found[0].rule, "principal");
        const AxisCandidate* torus = find(found, "revolution");
        ASSERT_NE(torus, nullptr);
        EXPECT_NEAR(torus->gap_rad, 1.5 * kPi, 0.01);
        EXPECT_NE(torus->why.find("270 deg are open"), std::string::npos) << torus->why;
        EXPECT_NEAR(torus->angle_rad, 0.5 * kPi, 1e-3);
        off_mm.push_back(std::abs(torus->swing_mm - bend.bend_radius_mm - bend.pipe_radius_mm));
    }
    EXPECT_LT(off_mm[0], 0.5);
    EXPECT_LT(off_mm[1], 0.4 * off_mm[0]);
}

// The chord goes through both centres: 45 deg to each leg's axis.
TEST(AxisCandidates, OfAnElbowTheChordIsNamedAndNotTaken) {
    const Mandrel elbow =
        build_mandrel(make_elbow({}, {.edge_mm = kEdge_mm}), "elbow.stl", {.unit_mm = 1.0});
    const std::vector<AxisCandidate> found = axis_candidates(elbow);
    const AxisCandidate* chord = find(found, "chord");
    ASSERT_NE(chord, nullptr);
    for (const Rim& rim : elbow.rims) {
        EXPECT_LT((rim.centre_mm - chord->through_mm).cross(chord->direction).norm(), 1e-6);
        EXPECT_NEAR(std::abs(rim.axis.dot(chord->direction)), std::sqrt(0.5), 1e-6);
    }
    EXPECT_EQ(chord->rims, 0);
    EXPECT_GT(chord->off_mm, 1.0);
}

TEST(AxisCandidates, OneThatIsGivenComesFirst) {
    const auto found =
        candidates(make_cylinder({.radius_mm = 30.0, .length_mm = 120.0}, {.edge_mm = kEdge_mm}),
                   {.unit_mm = 1.0,
                    .axis = MandrelOptions::Axis{.origin = Vector3d(0.0, 5.0, 0.0),
                                                 .direction = Vector3d::UnitZ()}});
    EXPECT_EQ(found[0].rule, "given");
    EXPECT_EQ(found[0].why, "the job gives it");
    EXPECT_NEAR(found[0].swing_mm, 35.0, 0.1);
    const AxisCandidate* rims = find(found, "coaxial-rims");
    ASSERT_NE(rims, nullptr);
    EXPECT_NEAR(rims->off_mm, 5.0, 1e-6);
    EXPECT_EQ(rims->why, "the job gives another");
}

// The figures do not depend on how the part lies in its file.
TEST(AxisCandidates, StayWithThePart) {
    TriangleSoup soup = make_tee({}, {.edge_mm = 10.0});
    const auto before = candidates(soup);
    const Eigen::AngleAxisd turn(0.7, Vector3d(1.0, 2.0, -0.5).normalized());
    for (Vector3d& p : soup.points_mm) {
        p = turn * p + Vector3d(100.0, -40.0, 7.0);
    }
    const auto after = candidates(soup);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
        EXPECT_EQ(after[i].rule, before[i].rule);
        EXPECT_NEAR(after[i].swing_mm, before[i].swing_mm, 1e-6);
        EXPECT_NEAR(after[i].angle_rad, before[i].angle_rad, 1e-6);
        EXPECT_NEAR(after[i].off_mm, before[i].off_mm, 1e-6);
        EXPECT_EQ(after[i].rims, before[i].rims);
    }
}

}  // namespace
}  // namespace meshwind
