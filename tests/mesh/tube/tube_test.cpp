#include "mesh/tube/tube.h"
#include "mesh/mandrel/load_mandrel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/units.h"
#include "mesh/shapes/make_kinds.h"
#include "mesh/tube/tube_chain.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Kind = TubePartKind;

TubeFinding found(const TriangleSoup& soup) {
    return find_tube(build_mandrel(soup, "part", {.unit_mm = 1.0}));
}

// A grid about a line: rings of `around` vertices, `rings` + 1 of them.
TriangleSoup skin(const CentreLine& line, double radius_mm, int rings, int around) {
    TriangleSoup soup;
    for (int i = 0; i <= rings; ++i) {
        const CentrePlace place = line.at(line.length_mm() * i / rings);
        for (int k = 0; k < around; ++k) {
            const double angle = 2.0 * kPi * (k + 0.5 * (i % 2)) / around;
            soup.points_mm.push_back(
                place.position_mm +
                radius_mm * (std::cos(angle) * place.reference + std::sin(angle) * place.across()));
        }
    }
    const auto at = [&](int ring, int k) { return ring * around + (k + around) % around; };
    for (int i = 0; i < rings; ++i) {
        for (int k = 0; k < around; ++k) {
            const int up = i % 2;  // odd rings are turned by half a step
            soup.faces.push_back({at(i, k), at(i, k + 1), at(i + 1, k + up)});
            soup.faces.push_back({at(i + 1, k + up), at(i + 1, k - 1 + up), at(i, k)});
        }
    }
    return soup;
}

// The readings of curvature are as many as the line has to tell, however thin the tube begins.
TEST(FindTube, ATubeThatBeginsWithAPointEnds) {
    const ElbowShape shape{40.0, 120.0, rad_from_deg(60.0), 150.0, 90.0};
    const Mandrel mandrel =
        build_mandrel(make_elbow(shape, {.edge_mm = 9.0}), "part", {.unit_mm = 1.0});
    TubeFinding finding = find_tube(mandrel);
    ASSERT_TRUE(finding.tube) << finding.why_not;
    finding.tube->radius.front().radius_mm = 1e-9;
    const std::optional<Tube> chain = chain_tube(mandrel.rims, mandrel.surface, *finding.tube);
    EXPECT_TRUE(!chain || std::isfinite(chain->line.length_mm()));
}

// Vertices lie on the tube to rounding, so line, radius and parts are exact whatever the mesh.
TEST(FindTube, ElbowsAndFramesAreExact) {
    for (const bool irregular : {false, true}) {
        for (const double edge : {5.0, 9.0}) {
            const ElbowShape shape{40.0, 120.0, rad_from_deg(60.0), 150.0, 90.0};
            const Mandrel mandrel =
                build_mandrel(make_elbow(shape, {.edge_mm = edge, .irregular = irregular}), "part",
                              {.unit_mm = 1.0});
            const TubeFinding finding = find_tube(mandrel);
            ASSERT_TRUE(finding.tube) << finding.why_not;
            const Tube& tube = *finding.tube;
            EXPECT_LT(tube.residual_mm, 1e-9);
            ASSERT_EQ(tube.radius.size(), 1U);
            EXPECT_NEAR(tube.radius_at(77.0), 40.0, 1e-9);
            ASSERT_EQ(tube.parts.size(), 3U);
            const bool forward = std::abs(tube.parts[0].to_mm - 150.0) < 1.0;
            EXPECT_EQ(tube.parts[1].kind, Kind::Bend);
            EXPECT_NEAR(tube.parts[1].bend_radius_mm, 120.0, 1e-8);
            EXPECT_NEAR(tube.parts[1].angle_rad, rad_from_deg(60.0), 1e-9);
            EXPECT_EQ(tube.parts[0].kind, Kind::Straight);
            EXPECT_NEAR(tube.parts[0].to_mm, forward ? 150.0 : 90.0, 1e-7);
            EXPECT_NEAR(tube.line.length_mm(), 240.0 + 40.0 * kPi, 1e-8);
            EXPECT_LT(std::max(tube.lean_rad[0], tube.lean_rad[1]), 1e-9);
            // From rim to rim; the reference away from the bend's centre.
            EXPECT_LT((tube.line.at(0.0).position_mm - mandrel.rims[0].centre_mm).norm(), 1e-8);
            EXPECT_LT((tube.line.nodes().back().position_mm - mandrel.rims[1].centre_mm).norm(),
                      1e-8);
            const CentrePlace middle =
                tube.line.at(0.5 * (tube.parts[1].from_mm + tube.parts[1].to_mm));
            EXPECT_NEAR(middle.reference.dot(middle.curvature_per_mm), -1.0 / 120.0, 1e-10);
        }
    }
    const auto frame = found(make_mandrel("frame", {}, {.edge_mm = 5.0, .irregular = true}));
    ASSERT_TRUE(frame.tube) << frame.why_not;
    ASSERT_EQ(frame.tube->parts.size(), 3U);
    EXPECT_NEAR(frame.tube->parts[1].bend_radius_mm, 60.0, 1e-8);
}

// Legs of a third of the radius: their curvature is read across the joints, and they are straight.
TEST(FindTube, ShortLegsAreStraight) {
    const ElbowShape shape{30.0, 90.0, rad_from_deg(90.0), 10.0, 10.0};
    const TubeFinding finding = found(make_elbow(shape, {.edge_mm = 4.0}));
    ASSERT_TRUE(finding.tube) << finding.why_not;
    const std::vector<TubePart>& parts = finding.tube->parts;
    ASSERT_EQ(parts.size(), 3U);
    EXPECT_EQ(parts[0].kind, Kind::Straight);
    EXPECT_EQ(parts[1].kind, Kind::Bend);
    EXPECT_EQ(parts[2].kind, Kind::Straight);
    EXPECT_NEAR(parts[1].bend_radius_mm, 90.0, 1e-6);
    EXPECT_NEAR(parts[0].to_mm, 10.0, 1e-5);
}

// A quarter to the side, a leg, a half turn out of its plane, and no leg after it.
TEST(FindTube, SpatialChainKeepsItsParts) {
    const CentreLine line(CentrePlace{}, {{90.0, {0.0, 0.0}},
                                          {40.0 * kPi, {1.0 / 80.0, 0.0}},
                                          {60.0, {0.0, 0.0}},
                                          {50.0 * kPi, {0.012, 0.016}}});
    const auto finding = found(skin(line, 25.0, 90, 30));
    ASSERT_TRUE(finding.tube) << finding.why_not;
    const Tube& tube = *finding.tube;
    EXPECT_LT(tube.residual_mm, 1e-8);
    ASSERT_EQ(tube.parts.size(), 4U);
    const bool forward = tube.parts.front().kind == Kind::Straight;
    const TubePart& quarter = tube.parts[forward ? 1 : 2];
    const TubePart& half = tube.parts[forward ? 3 : 0];
    EXPECT_NEAR(quarter.bend_radius_mm, 80.0, 1e-6);
    EXPECT_NEAR(quarter.angle_rad, 0.5 * kPi, 1e-8);
    EXPECT_NEAR(half.bend_radius_mm, 50.0, 1e-6);
    EXPECT_NEAR(half.angle_rad, kPi, 1e-8);
}

// A tube along a helix is no chain of arcs. Its centres come from local fits, quadratic along the
// line, to vertices on the tube.
TEST(FindTube, HelixIsACurveOfOrderTwoOrMore) {
    const double a = 70.0;
    const double slope = 0.3;
    const double length = 220.0;
    const auto helix = [&](double s) -> Vector3d {
        const double angle = s * std::cos(slope) / a;
        return {a * std::cos(angle), a * std::sin(angle), s * std::sin(slope)};
    };
    std::vector<Vector3d> points;
    constexpr int kPoints = 2000;
    for (int i = 0; i <= kPoints; ++i) {
        points.push_back(helix(length * i / kPoints));
    }
    const CentreLine truth = line_through(points);
    double last = std::numeric_limits<double>::infinity();
    for (const int rings : {22, 44, 88}) {
        const Mandrel mandrel =
            build_mandrel(skin(truth, 20.0, rings, rings / 2 + 2), "part", {.unit_mm = 1.0});
        const TubeFinding finding = find_tube(mandrel);
        ASSERT_TRUE(finding.tube) << finding.why_not;
        const Tube& tube = *finding.tube;
        ASSERT_EQ(tube.parts.size(), 1U);
        EXPECT_EQ(tube.parts[0].kind, Kind::Curve);
        // Curvature cos^2 / a.
        EXPECT_NEAR(tube.parts[0].angle_rad, std::pow(std::cos(slope), 2) / a * length, 0.05);
        double worst = 0.0;
        for (int i = 0; i <= 100; ++i) {
            const Vector3d there = mandrel.file_to_mandrel * helix(length * i / 100);
            worst = std::max(worst, (tube.line.foot(there).position_mm - there).norm());
        }
        EXPECT_LT(worst, last / 4.0) << rings;
        EXPECT_LT(tube.residual_mm, 3.0 * worst + 1e-6) << rings;
        last = worst;
    }
    EXPECT_LT(last, 0.01);
}

TEST(FindTube, ConeIsATubeOfVaryingRadius) {
    const auto finding = found(make_mandrel("cone", {}, {.edge_mm = 8.0}));
    ASSERT_TRUE(finding.tube) << finding.why_not;
    const Tube& tube = *finding.tube;
    ASSERT_EQ(tube.parts.size(), 1U);
    EXPECT_EQ(tube.parts[0].kind, Kind::Straight);
    EXPECT_NEAR(tube.radius_at(100.0), 45.0, 1e-5);
    EXPECT_NEAR(tube.radius_at(-5.0), tube.radius_at(0.0), 0.0);
    EXPECT_NEAR(tube.radius_at(1e3), tube.radius_at(200.1), 0.0);
}

TEST(FindTube, RefusesWithTheReason) {
    const auto reason = [](const TriangleSoup& soup) {
        const TubeFinding finding = found(soup);
        EXPECT_EQ(finding.tube.has_value(), finding.why_not.empty());
        return finding.why_not;
    };
    const auto has = [](const std::string& text, const char* words) {
        return text.find(words) != std::string::npos;
    };
    EXPECT_PRED2(has, reason(make_mandrel("tee", {}, {.edge_mm = 8.0})), "3 rims");
    EXPECT_PRED2(has, reason(make_mandrel("torus", {}, {.edge_mm = 15.0})), "0 rims");
    EXPECT_PRED2(has, reason(make_mandrel("vessel", {}, {.edge_mm = 8.0})), "round");
    // An oval elbow: wider across by 1.5 %, 0.3 mm off the mean of 40 mm.
    TriangleSoup oval = make_mandrel("elbow", {}, {.edge_mm = 6.0});
    for (Vector3d& p : oval.points_mm) {
        p.y() *= 1.015;
    }
    EXPECT_PRED2(has, reason(oval), "off the tube that comes nearest");
    const Mandrel wye = load_mandrel(MESHWIND_SOURCE_DIR "/data/meshes/wye_4way_tetra.stl");
    EXPECT_PRED2(has, find_tube(wye).why_not, "rims, a tube has two");
}

}  // namespace
}  // namespace meshwind
