#include "mesh/revolution/revolution.h"
#include "mesh/mandrel/load_mandrel.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/shapes/make_kinds.h"
#include "mesh/shapes/profile.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Kind = MeridianPartKind;

std::string mesh_file(const char* name) {
    return std::string(MESHWIND_SOURCE_DIR "/data/meshes/") + name;
}

RevolutionFinding found(const TriangleSoup& soup, const MandrelOptions& options = {}) {
    return find_revolution(build_mandrel(soup, "part", options));
}

// The frame of the profile, so that no search for the axis comes between.
MandrelOptions as_made() {
    return {.unit_mm = 1.0, .axis = MandrelOptions::Axis{Vector3d::Zero(), Vector3d::UnitZ()}};
}

double length_of(const Profile& profile) {
    double length = 0.0;
    for (const ProfilePiece& piece : profile) {
        length += piece.length_mm();
    }
    return length;
}

struct Errors {
    double place_mm = 0.0;
    double slope_rad = 0.0;
    double length_mm = 0.0;
};

// Distance and direction of the ideal profile at places all along the meridian; at a crease of the
// profile, where its normal jumps, only the distance.
Errors errors_of(const Meridian& meridian, const Profile& profile) {
    Errors worst;
    worst.length_mm = std::abs(meridian.length_mm() - length_of(profile));
    constexpr int kPlaces = 1999;
    for (int i = 0; i <= kPlaces; ++i) {
        const double arc = meridian.length_mm() * i / kPlaces;
        const MeridianPlace place = meridian.at(arc);
        const ShapeFoot foot =
            profile_foot(profile, {std::max(place.radius_mm, 1e-9), 0.0, place.z_mm});
        worst.place_mm = std::max(worst.place_mm, std::abs(foot.distance_mm));
        const bool at_crease =
            std::any_of(meridian.creases_mm().begin(), meridian.creases_mm().end(),
                        [&](double crease) { return std::abs(crease - arc) < 0.01; });
        if (!at_crease) {
            const double slope = std::atan2(-foot.normal.z(), foot.normal.x());
            worst.slope_rad = std::max(worst.slope_rad, std::abs(slope - place.slope_rad));
        }
    }
    return worst;
}

std::vector<Kind> kinds_of(const BodyOfRevolution& body) {
    std::vector<Kind> kinds;
    for (const MeridianPart& part : body.parts) {
        kinds.push_back(part.kind);
    }
    return kinds;
}

TEST(FindRevolution, CylinderIsExactOnAnyMesh) {
    for (const bool irregular : {false, true}) {
        const auto finding = found(make_cylinder({.radius_mm = 40.0, .length_mm = 251.0},
                                                 {.edge_mm = 6.0, .irregular = irregular}));
        ASSERT_TRUE(finding.body) << finding.why_not;
        const BodyOfRevolution& body = *finding.body;
        EXPECT_LT(body.residual_mm, 1e-9);
        ASSERT_EQ(body.parts.size(), 1U);
        EXPECT_EQ(body.parts[0].kind, Kind::Cylinder);
        EXPECT_NEAR(body.parts[0].radius_mm, 40.0, 1e-9);
        EXPECT_NEAR(body.meridian.length_mm(), 251.0, 1e-9);
        EXPECT_NEAR(body.meridian.at(0.0).z_mm, -125.5, 1e-9);
        EXPECT_EQ(body.meridian.at(100.0).slope_rad, 0.0);
        EXPECT_EQ(body.meridian.at(100.0).curvature_per_mm, 0.0);
        EXPECT_EQ(body.end[0].kind, MeridianEnd::Kind::Rim);
        EXPECT_EQ(body.end[1].kind, MeridianEnd::Kind::Rim);
        EXPECT_NE(body.end[0].rim, body.end[1].rim);
    }
}

TEST(FindRevolution, ConeKeepsItsAngle) {
    const auto finding = found(make_cone({}, {.edge_mm = 6.0, .irregular = true}));
    ASSERT_TRUE(finding.body) << finding.why_not;
    ASSERT_EQ(kinds_of(*finding.body), std::vector<Kind>{Kind::Cone});
    EXPECT_NEAR(finding.body->parts[0].slope_rad, std::atan2(-30.0, 200.0), 1e-12);
    EXPECT_NEAR(finding.body->parts[0].radius_mm, 45.0, 1e-9);
}

struct Case {
    const char* name;
    bool irregular;
    double place_mm, slope_rad;  // allowed with edges of 4 mm
    double place_order;          // observed at least over halving the edges
};

// Rings: a cubic between nodes h apart on the smallest radius of curvature R is off by h^4 / 384 /
// R^3, R = 33 mm beside the vessel's cylinder. Scatter: the fit of degree four over 2.5 edges on
// both sides leaves 2.5^5 / 16 h^5 and less, and the joint is found within h^4 / R^3.
TEST(FindRevolution, DomesOfAVesselConverge) {
    const VesselShape shape;
    const Profile profile = profile_of(shape);
    for (const Case& c :
         {Case{"rings", false, 1e-4, 1e-4, 3.5}, {"scatter", true, 1e-3, 1e-3, 3.0}}) {
        SCOPED_TRACE(c.name);
        Errors coarse;
        for (const double edge_mm : {4.0, 2.0}) {
            const auto finding =
                found(make_vessel(shape, {.edge_mm = edge_mm, .irregular = c.irregular}));
            ASSERT_TRUE(finding.body) << finding.why_not;
            const BodyOfRevolution& body = *finding.body;
            ASSERT_EQ(kinds_of(body), (std::vector<Kind>{Kind::Dome, Kind::Cylinder, Kind::Dome}));
            EXPECT_TRUE(body.meridian.creases_mm().empty());
            EXPECT_NEAR(body.parts[1].radius_mm, 75.0, 1e-9);
            EXPECT_NEAR(body.parts[1].from_mm, profile[0].length_mm(), 0.01 * edge_mm);
            EXPECT_NEAR(body.meridian.widest_mm(), 0.5 * length_of(profile), 0.01 * edge_mm);
            const Errors errors = errors_of(body.meridian, profile);
            const double finer = edge_mm / 4.0;
            EXPECT_LT(errors.place_mm, c.place_mm * std::pow(finer, c.place_order));
            EXPECT_LT(errors.slope_rad, c.slope_rad * std::pow(finer, 2.0));
            EXPECT_LT(errors.length_mm, c.place_mm);
            EXPECT_LE(body.residual_mm, c.place_mm);
            if (coarse.place_mm > 0.0) {
                EXPECT_GT(std::log2(coarse.place_mm / errors.place_mm), c.place_order);
                EXPECT_GT(std::log2(coarse.slope_rad / errors.slope_rad), c.place_order - 1.0);
            }
            coarse = errors;
        }
    }
}

// Dome of radius 70 with edges of 2 mm: the accuracy that planning on the meridian asks for.
TEST(FindRevolution, SphereHasPolesOnTheAxis) {
    for (const bool irregular : {false, true}) {
        const EllipsoidShape shape{.equator_radius_mm = 70.0, .pole_radius_mm = 70.0};
        const auto finding =
            found(make_ellipsoid(shape, {.edge_mm = 2.0, .irregular = irregular}), as_made());
        ASSERT_TRUE(finding.body) << finding.why_not;
        const BodyOfRevolution& body = *finding.body;
        EXPECT_EQ(kinds_of(body), std::vector<Kind>{Kind::Dome});
        EXPECT_EQ(body.end[0].kind, MeridianEnd::Kind::Pole);
        EXPECT_EQ(body.end[1].kind, MeridianEnd::Kind::Pole);
        const Meridian& meridian = body.meridian;
        EXPECT_EQ(meridian.at(0.0).radius_mm, 0.0);
        EXPECT_NEAR(meridian.at(0.0).slope_rad, 0.5 * kPi, 1e-12);
        EXPECT_NEAR(meridian.at(meridian.length_mm()).slope_rad, -0.5 * kPi, 1e-12);
        EXPECT_NEAR(meridian.widest_mm(), 35.0 * kPi, 1e-2);
        const Errors errors = errors_of(meridian, profile_of(shape));
        EXPECT_LT(errors.place_mm, 1e-4);
        EXPECT_LT(errors.slope_rad, 1e-4);
        EXPECT_LT(errors.length_mm, 1e-3);
        for (const double share : {0.05, 0.3, 0.7}) {
            EXPECT_NEAR(meridian.at(share * meridian.length_mm()).curvature_per_mm, 1.0 / 70.0,
                        2e-3 / 70.0);
        }
    }
}

// Its creases turn by 18 degrees, too little for feature edges: the lines meet all the same.
TEST(FindRevolution, CombinationHasBothCreases) {
    const CombinationShape shape;
    const Profile profile = profile_of(shape);
    for (const bool irregular : {false, true}) {
        const auto finding =
            found(make_combination(shape, {.edge_mm = 4.0, .irregular = irregular}));
        ASSERT_TRUE(finding.body) << finding.why_not;
        const BodyOfRevolution& body = *finding.body;
        ASSERT_EQ(kinds_of(body),
                  (std::vector<Kind>{Kind::Cylinder, Kind::Cone, Kind::Cylinder, Kind::Dome}));
        ASSERT_EQ(body.meridian.creases_mm().size(), 2U);
        EXPECT_NEAR(body.meridian.creases_mm()[0], 120.0, 1e-9);
        EXPECT_NEAR(body.meridian.creases_mm()[1], 120.0 + std::hypot(60.0, 20.0), 1e-9);
        EXPECT_NEAR(body.parts[0].radius_mm, 60.0, 1e-9);
        EXPECT_NEAR(body.parts[2].radius_mm, 40.0, 1e-9);
        EXPECT_NEAR(body.meridian.length_mm(), length_of(profile), 1e-3);
    }
}

// Sharp creases as feature edges, a step that runs square to the axis, and facets as CAD makes
// them: no vertex between the ends of a line.
TEST(FindRevolution, SteppedPipeWithoutInnerVertices) {
    const auto finding = found(test::revolve(
        {{20.0, 0.0}, {20.0, 30.0}, {35.0, 30.0}, {35.0, 70.0}, {25.0, 80.0}, {25.0, 150.0}}, 72));
    ASSERT_TRUE(finding.body) << finding.why_not;
    const BodyOfRevolution& body = *finding.body;
    ASSERT_EQ(kinds_of(body), (std::vector<Kind>{Kind::Cylinder, Kind::Cone, Kind::Cylinder,
                                                 Kind::Cone, Kind::Cylinder}));
    EXPECT_EQ(body.meridian.creases_mm().size(), 4U);
    EXPECT_NEAR(body.parts[1].slope_rad, 0.5 * kPi, 1e-12);
    EXPECT_NEAR(body.meridian.length_mm(), 30 + 15 + 40 + std::hypot(10.0, 10.0) + 70, 1e-9);
    EXPECT_LT(body.residual_mm, 1e-9);
}

// The same with angles of 5 to 27 degrees, which are no feature edges.
TEST(FindRevolution, ShallowConesWithoutInnerVertices) {
    const std::vector<Eigen::Vector2d> profile = {{30.0, 0.0},   {30.0, 60.0},  {36.0, 130.0},
                                                  {36.0, 200.0}, {26.0, 220.0}, {26.0, 300.0}};
    const auto finding = found(test::revolve(profile, 90));
    ASSERT_TRUE(finding.body) << finding.why_not;
    const BodyOfRevolution& body = *finding.body;
    ASSERT_EQ(kinds_of(body), (std::vector<Kind>{Kind::Cylinder, Kind::Cone, Kind::Cylinder,
                                                 Kind::Cone, Kind::Cylinder}));
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        length += (profile[i + 1] - profile[i]).norm();
    }
    EXPECT_NEAR(body.meridian.length_mm(), length, 1e-9);
    EXPECT_NEAR(body.meridian.at(30.0).radius_mm, 30.0, 1e-9);
}

// A dome of eight rings is a curve all the same.
TEST(FindRevolution, CoarseDomeIsCurved) {
    std::vector<Eigen::Vector2d> profile;
    constexpr int kRings = 8;
    for (int i = 0; i <= kRings; ++i) {
        const double angle = 1.2 * i / kRings;
        profile.emplace_back(60.0 * std::cos(angle), 60.0 * std::sin(angle));
    }
    const auto finding = found(test::revolve(profile, 180));
    ASSERT_TRUE(finding.body) << finding.why_not;
    ASSERT_EQ(kinds_of(*finding.body), std::vector<Kind>{Kind::Dome});
    // Free ends, h = 9 mm: ten times 60 h^4 / 384 in radii.
    for (const double arc : {5.0, 30.0, 60.0}) {
        const MeridianPlace place = finding.body->meridian.at(arc);
        EXPECT_NEAR(std::hypot(place.radius_mm, place.z_mm - finding.body->meridian.at(0.0).z_mm),
                    60.0, 1e-3);
    }
}

// Domes with rings and a cylinder between without any: long facets are straight.
TEST(FindRevolution, CylinderWithoutInnerRingsBetweenDomes) {
    std::vector<Eigen::Vector2d> profile;
    constexpr int kRings = 16;
    for (int i = 0; i <= kRings; ++i) {
        const double angle = -1.3 + 1.3 * i / kRings;
        profile.emplace_back(60.0 * std::cos(angle), 60.0 * std::sin(angle));
    }
    for (int i = 0; i <= kRings; ++i) {
        const double angle = 1.3 * i / kRings;
        profile.emplace_back(60.0 * std::cos(angle), 200.0 + 60.0 * std::sin(angle));
    }
    const auto finding = found(test::revolve(profile, 96));
    ASSERT_TRUE(finding.body) << finding.why_not;
    const BodyOfRevolution& body = *finding.body;
    ASSERT_EQ(kinds_of(body), (std::vector<Kind>{Kind::Dome, Kind::Cylinder, Kind::Dome}));
    EXPECT_TRUE(body.meridian.creases_mm().empty());
    EXPECT_NEAR(body.parts[1].to_mm - body.parts[1].from_mm, 200.0, 1e-9);
    // h = 4.9 mm: 60 h^4 / 384 in radii, and free ends cost ten times that.
    EXPECT_NEAR(body.meridian.length_mm(), 200.0 + 2 * 60.0 * 1.3, 1e-4);
}

TEST(FindRevolution, FileInAnotherPlaceAndUnitIsTheSameBody) {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.rotate(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
    motion.pretranslate(Vector3d(50, -20, 10));
    TriangleSoup soup = test::moved(make_vessel({}, {.edge_mm = 4.0}), motion);
    for (Vector3d& p : soup.points_mm) {
        p /= 25.4;
    }
    const auto finding = found(soup, {.unit_mm = 25.4});
    ASSERT_TRUE(finding.body) << finding.why_not;
    EXPECT_LT(finding.body->residual_mm, 1e-6);
    EXPECT_NEAR(finding.body->meridian.length_mm(), length_of(profile_of(VesselShape{})), 1e-4);
    EXPECT_NEAR(finding.body->parts[1].radius_mm, 75.0, 1e-9);
}

TEST(FindRevolution, ExportedCapsuleIsOne) {
    for (const auto mesh : {MandrelOptions::Mesh::File, MandrelOptions::Mesh::Even}) {
        const std::optional<BodyOfRevolution> body =
            find_revolution(
                load_mandrel(mesh_file("vessel_capsule_seam_degenerate.obj"), {.mesh = mesh}))
                .body;
        ASSERT_TRUE(body);
        EXPECT_EQ(kinds_of(*body), (std::vector<Kind>{Kind::Dome, Kind::Cylinder, Kind::Dome}));
        // The file has millionths of its radius, 1 m; the even mesh is swept about a meridian that
        // was fitted to it, and fitted once more.
        EXPECT_LT(body->residual_mm, mesh == MandrelOptions::Mesh::File ? 2e-3 : 5e-3);
        EXPECT_NEAR(body->parts[1].radius_mm, 1000.0, 1e-3);
        EXPECT_NEAR(body->meridian.length_mm(), 1000.0 * (1.0 + kPi), 1e-2);
    }
}

// Vertices off the surface at random, as a mesher leaves them on a part that was coarse before.
TEST(FindRevolution, RoughMeshKeepsItsParts) {
    TriangleSoup soup =
        make_combination({.opening_radius_mm = 15.0}, {.edge_mm = 3.0, .irregular = true});
    for (std::size_t i = 0; i < soup.points_mm.size(); ++i) {
        Vector3d& p = soup.points_mm[i];
        const double off = 0.02 * std::sin(12.9898 * static_cast<double>(i * i % 7919));
        p.head<2>() *= 1.0 + off / p.head<2>().norm();
    }
    const auto finding = found(soup);
    ASSERT_TRUE(finding.body) << finding.why_not;
    EXPECT_EQ(kinds_of(*finding.body),
              (std::vector<Kind>{Kind::Cylinder, Kind::Cone, Kind::Cylinder, Kind::Dome}));
    EXPECT_GT(finding.body->residual_mm, 0.01);
    EXPECT_LT(finding.body->residual_mm, 0.04);
    EXPECT_NEAR(finding.body->parts[0].radius_mm, 60.0, 0.002);
}

TEST(FindRevolution, RefusesWithTheReason) {
    const auto reason = [](const TriangleSoup& soup, const MandrelOptions& options = {}) {
        const auto finding = found(soup, options);
        EXPECT_EQ(finding.body.has_value(), finding.why_not.empty());
        return finding.why_not;
    };
    const auto has = [](const std::string& text, const char* words) {
        return text.find(words) != std::string::npos;
    };
    EXPECT_PRED2(has, reason(make_mandrel("tee")), "3 rims");
    EXPECT_PRED2(has, reason(make_mandrel("elbow")), "not square to the spindle");
    EXPECT_PRED2(has, reason(make_mandrel("torus")), "two ends");
    EXPECT_PRED2(has,
                 reason(make_cylinder({}, {.edge_mm = 8.0}),
                        {.axis = MandrelOptions::Axis{{2.0, 0.0, 0.0}, Vector3d::UnitZ()}}),
                 "off the axis");
    // A square tube: all vertices at one distance from the axis, and yet not round.
    EXPECT_PRED2(has, reason(test::tube(30.0, 200.0, 4)), "creases along");
    // An oval: 2 % longer than wide, 0.4 mm off the mean of 40 mm.
    TriangleSoup oval = make_cylinder({.radius_mm = 40.0, .length_mm = 251.0}, {.edge_mm = 6.0});
    for (Vector3d& p : oval.points_mm) {
        p.x() *= 1.01;
        p.y() *= 0.99;
    }
    EXPECT_PRED2(has, reason(oval), "more than 0.20");
    // A dent half a millimetre deep in the dome.
    TriangleSoup dented = make_vessel({}, {.edge_mm = 4.0});
    for (Vector3d& p : dented.points_mm) {
        const double away = (p - Vector3d(75.0, 0.0, 0.0)).norm();
        p.x() -= 0.6 * std::exp(-away * away / 100.0);
    }
    EXPECT_PRED2(has, reason(dented), "off a surface of revolution");
}

}  // namespace
}  // namespace meshwind
