#include "mesh/mandrel/load_mandrel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

std::string mesh_file(const char* name) {
    return std::string(MESHWIND_SOURCE_DIR "/data/meshes/") + name;
}

int count_kind(const Mandrel& mandrel, RegionKind kind) {
    return static_cast<int>(std::count_if(mandrel.regions.begin(), mandrel.regions.end(),
                                          [&](const Region& r) { return r.kind == kind; }));
}

// Rim in the file's frame and units.
struct FileRim {
    Vector3d centre;
    Vector3d axis;
    double radius = 0.0;
};

std::vector<FileRim> rims_in_file(const Mandrel& mandrel) {
    const Eigen::Affine3d back = mandrel.file_to_mandrel.inverse();
    std::vector<FileRim> rims;
    for (const Rim& rim : mandrel.rims) {
        rims.push_back({back * rim.centre_mm, (back.linear() * rim.axis).normalized(),
                        rim.radius_mm / mandrel.unit_mm});
    }
    return rims;
}

// True when one rim has this axis, a centre on this line, and this radius, all within 1 % of it.
bool has_rim(const Mandrel& mandrel, const Vector3d& on_line, const Vector3d& axis, double radius) {
    const std::vector<FileRim> rims = rims_in_file(mandrel);
    return std::count_if(rims.begin(), rims.end(), [&](const FileRim& rim) {
               return rim.axis.dot(axis) > 0.0 && rim.axis.cross(axis).norm() < 0.01 &&
                      (rim.centre - on_line).cross(axis).norm() < 0.01 * radius &&
                      std::abs(rim.radius - radius) < 0.01 * radius;
           }) == 1;
}

Eigen::Isometry3d somewhere() {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.rotate(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
    motion.pretranslate(Vector3d(50, -20, 10));
    return motion;
}

const MandrelOptions kAsItCame{.mesh = MandrelOptions::Mesh::File};

TEST(BuildMandrel, HollowPipeKeepsItsOuterWall) {
    const TriangleSoup pipe = test::moved(test::pipe(20.0, 17.0, 200.0, 24), somewhere());
    const Mandrel m = build_mandrel(pipe, "pipe", kAsItCame);
    EXPECT_EQ(count_kind(m, RegionKind::OuterWall), 1);
    EXPECT_EQ(count_kind(m, RegionKind::Bore), 1);
    EXPECT_EQ(count_kind(m, RegionKind::EndCap), 2);
    EXPECT_EQ(m.surface.face.size(), 48U);
    EXPECT_EQ(m.axis.rule, "coaxial-rims");
    ASSERT_EQ(m.rims.size(), 2U);
    for (const Rim& rim : m.rims) {
        EXPECT_NEAR(rim.radius_mm, 20.0, 1e-9);
        EXPECT_NEAR(rim.centre_mm.head<2>().norm(), 0.0, 1e-9);
        EXPECT_NEAR(std::abs(rim.centre_mm.z()), 100.0, 1e-9);
        EXPECT_GT(rim.centre_mm.z() * rim.axis.z(), 0.0);
    }
}

TEST(BuildMandrel, ShortRingKeepsItsOuterWall) {
    const Mandrel m = build_mandrel(test::pipe(50.0, 45.0, 12.0, 48), "ring");
    ASSERT_EQ(m.rims.size(), 2U);
    EXPECT_NEAR(m.rims[0].radius_mm, 50.0, 1e-9);
}

TEST(BuildMandrel, StepsAndCollarsStayInTheWallAndBoreStepsDoNot) {
    // Socket at one end outside (R 15) and inside (R 13.5), chamfers at the other end's mouth.
    const Mandrel m = build_mandrel(test::revolve({{15, 0},
                                                   {15, 20},
                                                   {13, 20},
                                                   {13, 80},
                                                   {12, 80},
                                                   {11, 79},
                                                   {11, 18},
                                                   {13.5, 18},
                                                   {13.5, 0},
                                                   {15, 0}},
                                                  48),
                                    "socket", kAsItCame);
    ASSERT_EQ(m.rims.size(), 2U);
    std::vector<double> radii = {m.rims[0].radius_mm, m.rims[1].radius_mm};
    std::sort(radii.begin(), radii.end());
    EXPECT_NEAR(radii[0], 13.0, 1e-9);
    EXPECT_NEAR(radii[1], 15.0, 1e-9);
    EXPECT_EQ(m.surface.face.size(), 3U * 96U);  // collar, step, wall
}

// A pipe closed by a plate with a drilled hole, so the bore opens through the side of a solid.
TEST(BuildMandrel, WallsOfHolesIntoTheBoreAreBore) {
    const Mandrel m = build_mandrel(test::revolve({{30, 0},
                                                   {30, 100},
                                                   {24, 110},
                                                   {12, 116},
                                                   {8, 116.5},
                                                   {8, 112},
                                                   {11, 112},
                                                   {22, 106},
                                                   {26, 98},
                                                   {26, 0},
                                                   {30, 0}},
                                                  48),
                                    "vessel", kAsItCame);
    ASSERT_EQ(m.rims.size(), 2U);
    std::vector<double> radii = {m.rims[0].radius_mm, m.rims[1].radius_mm};
    std::sort(radii.begin(), radii.end());
    EXPECT_NEAR(radii[0], 8.0, 1e-9);
    EXPECT_NEAR(radii[1], 30.0, 1e-9);
    EXPECT_EQ(m.surface.face.size(), 4U * 96U);
}

TEST(BuildMandrel, ClosedVesselHasNoRims) {
    std::vector<Eigen::Vector2d> profile;
    for (int i = 0; i <= 24; ++i) {
        const double angle = kPi * (i / 24.0 - 0.5);
        profile.emplace_back(i % 24 == 0 ? 0.0 : 30.0 * std::cos(angle), 45.0 * std::sin(angle));
    }
    const Mandrel m = build_mandrel(test::moved(test::revolve(profile, 36), somewhere()), "egg");
    EXPECT_TRUE(m.rims.empty());
    EXPECT_EQ(m.axis.rule, "revolution");
    // The poles lie on the axis.
    for (const Vector3d& p : m.surface.position_mm) {
        EXPECT_LT(p.head<2>().norm(), 30.0 + 1e-6);
    }
}

TEST(BuildMandrel, GivenAxisIsTakenAsItIs) {
    MandrelOptions options;
    options.axis = {{.origin = {0, 0, 5}, .direction = {0, 0, -2}}};
    const Mandrel m = build_mandrel(test::tube(10.0, 40.0, 24), "tube", options);
    EXPECT_EQ(m.axis.rule, "given");
    EXPECT_NEAR((m.file_to_mandrel * Vector3d(0, 0, 5)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((m.file_to_mandrel * Vector3d(0, 0, 4)).z(), 1.0, 1e-12);
}

TEST(BuildMandrel, NamedRegionsReplaceTheWall) {
    MandrelOptions options;
    options.keep_regions = {1};
    const Mandrel m = build_mandrel(test::pipe(20.0, 17.0, 200.0, 24), "pipe", options);
    EXPECT_EQ(m.regions[1].kind, RegionKind::Bore);
    ASSERT_EQ(m.rims.size(), 2U);
    EXPECT_NEAR(m.rims[0].radius_mm, 17.0, 1e-9);
    options.keep_regions = {9};
    EXPECT_THROW((void)build_mandrel(test::tube(10.0, 40.0, 24), "tube", options), InputError);
}

TEST(BuildMandrel, TakesSmallFilesForMetres) {
    const Mandrel metres = build_mandrel(test::tube(0.1, 2.0, 24), "tube", kAsItCame);
    EXPECT_EQ(metres.unit_mm, 1000.0);
    EXPECT_EQ(metres.unit_rule, "assumed");
    EXPECT_EQ(metres.remarks.size(), 1U);
    const Mandrel given = build_mandrel(test::tube(0.1, 2.0, 24), "tube", {.unit_mm = 1.0});
    EXPECT_EQ(given.unit_rule, "given");
    EXPECT_NEAR(given.rims.at(0).radius_mm, 0.1, 1e-12);
}

TEST(BuildMandrel, RefusesCoordinatesOutOfAnyRange) {
    TriangleSoup soup = test::tube(10.0, 40.0, 24);
    soup.points_mm[5].x() = 1e37;
    EXPECT_THROW((void)build_mandrel(soup, "tube"), InputError);
    EXPECT_THROW((void)build_mandrel(test::tube(1e-9, 1e-8, 24), "tube"), InputError);
}

// So far out single precision, which rays are traced with, has no digit left for what sees what.
TEST(BuildMandrel, RefusesAPartWithoutAWallAndNamesItsRegions) {
    const TriangleSoup far_out = test::moved(
        test::tube(40.0, 200.0, 24, 20), Eigen::Isometry3d(Eigen::Translation3d(1e7, 1e7, 1e7)));
    try {
        (void)build_mandrel(far_out, "tube");
        ADD_FAILURE() << "a part without a wall was taken";
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), "mesh.no_wall");
        const std::string words = error.what();
        EXPECT_NE(words.find("0 (bore, "), std::string::npos) << words;
        EXPECT_NE(words.find("keep_regions"), std::string::npos) << words;
    }
    EXPECT_EQ(build_mandrel(far_out, "tube", {.keep_regions = {0}}).surface.face.size(), 960U);
}

// A square tube without ends, with a raised ring of 12 mm on one side: the ring's top is no end,
// and what it surrounds no bore.
TEST(BuildMandrel, OpenSkinWithALetterKeepsAllOfIt) {
    TriangleSoup soup;
    const auto corners = [&](double half_x, double low_z, double high_z, double y) {
        const auto first = static_cast<std::int32_t>(soup.points_mm.size());
        soup.points_mm.insert(
            soup.points_mm.end(),
            {{-half_x, y, low_z}, {-half_x, y, high_z}, {half_x, y, high_z}, {half_x, y, low_z}});
        return first;
    };
    const auto quad = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
        soup.faces.push_back({a, b, c});
        soup.faces.push_back({a, c, d});
    };
    const std::int32_t front = corners(50.0, 0.0, 200.0, 50.0);
    const std::int32_t back = corners(50.0, 0.0, 200.0, -50.0);
    quad(back, back + 3, back + 2, back + 1);
    quad(back, back + 1, front + 1, front);
    quad(back + 2, back + 3, front + 3, front + 2);
    std::int32_t around = front;
    for (const auto& [half, y] : {std::pair(6.0, 50.0), {5.8, 50.5}, {3.0, 50.5}, {2.8, 50.0}}) {
        const std::int32_t ring = corners(half, 100.0 - half, 100.0 + half, y);
        for (int i = 0; i < 4; ++i) {
            const int next = (i + 1) % 4;
            quad(around + i, around + next, ring + next, ring + i);
        }
        around = ring;
    }
    quad(around, around + 1, around + 2, around + 3);
    const Mandrel m = build_mandrel(soup, "skin", kAsItCame);
    EXPECT_EQ(m.surface.face.size(), soup.faces.size());
    EXPECT_EQ(m.rims.size(), 2U);
}

// A closed vessel with a pimple of 1 mm2: its flat top is no end of the vessel.
TEST(BuildMandrel, ASpeckOfAClosedVesselIsNoEnd) {
    TriangleSoup soup = test::revolve({{0, 0}, {30, 30}, {30, 90}, {0, 120}}, 48);
    const std::size_t wall = soup.faces.size() / 2;  // one of the cylinder's
    const auto outer = soup.faces[wall];
    std::array<Vector3d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
        p[i] = soup.points_mm[static_cast<std::size_t>(outer[i])];
    }
    const Vector3d middle = (p[0] + p[1] + p[2]) / 3.0;
    const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    ASSERT_LT(std::abs(normal.z()), 1e-9);
    const auto ring = [&](double scale, double height) {
        std::array<std::int32_t, 3> ids{};
        for (std::size_t i = 0; i < 3; ++i) {
            ids[i] = static_cast<std::int32_t>(soup.points_mm.size());
            soup.points_mm.push_back(middle + scale * (p[i] - middle) + height * normal);
        }
        return ids;
    };
    const auto foot = ring(0.12, 0.0);
    const auto top = ring(0.1, 0.5);
    soup.faces[wall] = top;
    const auto between = [&](const auto& a, const auto& b) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            soup.faces.push_back({a[i], a[j], b[j]});
            soup.faces.push_back({a[i], b[j], b[i]});
        }
    };
    between(outer, foot);
    between(foot, top);
    EXPECT_EQ(count_kind(build_mandrel(soup, "vessel", kAsItCame), RegionKind::EndCap), 0);
}

// A quarter of a torus lies about the torus' own axis as well, and nothing could hold it there.
TEST(BuildMandrel, ABendIsNoBodyOfRevolution) {
    const Mandrel bend =
        build_mandrel(make_mandrel("elbow", {{"leg1", 10.0}, {"leg2", 10.0}}, {.edge_mm = 6.0}),
                      "bend", kAsItCame);
    EXPECT_NE(bend.axis.rule, "revolution");
}

TEST(BuildMandrel, HollowSquareTubeKeepsItsFourSides) {
    TriangleSoup soup = test::pipe(30.0, 25.0, 150.0, 4);
    const Mandrel m = build_mandrel(soup, "square");
    EXPECT_EQ(m.rims.size(), 2U);
    EXPECT_EQ(count_kind(m, RegionKind::EndCap), 2);
    EXPECT_EQ(count_kind(m, RegionKind::OuterWall), 4);
}

TEST(BuildMandrel, SameInputGivesTheSameBytes) {
    const TriangleSoup soup = test::moved(test::pipe(20.0, 17.0, 200.0, 24), somewhere());
    const Mandrel a = build_mandrel(soup, "pipe");
    const Mandrel b = build_mandrel(soup, "pipe");
    EXPECT_EQ(a.surface.position_mm, b.surface.position_mm);
    EXPECT_EQ(a.surface.face, b.surface.face);
}

// Run OD 26 with a socket OD 30 at its far end along x, branch OD 26 at x = -37 along +y.
TEST(LoadMandrel, LetteredTeeHasThreeEnds) {
    const Mandrel m = load_mandrel(mesh_file("tee_tetra_large_t.stl"));
    ASSERT_EQ(m.rims.size(), 3U);
    EXPECT_TRUE(has_rim(m, {0, 0, 0}, {1, 0, 0}, 13.0));
    EXPECT_TRUE(has_rim(m, {0, 0, 0}, {-1, 0, 0}, 15.0));
    EXPECT_TRUE(has_rim(m, {-37, 0, 0}, {0, 1, 0}, 13.0));
    EXPECT_EQ(m.axis.rule, "coaxial-rims");
    // The branch points along +X of the mandrel.
    EXPECT_NEAR((m.file_to_mandrel.linear() * Vector3d::UnitY()).x(), 1.0, 1e-4);
}

// One stem and four parallel legs on a circle of D 46, OD 21.5.
TEST(LoadMandrel, FourWayWyeHasFiveEnds) {
    const Mandrel m = load_mandrel(mesh_file("wye_4way_tetra.stl"));
    ASSERT_EQ(m.rims.size(), 5U);
    int legs = 0;
    for (const Rim& rim : m.rims) {
        EXPECT_NEAR(rim.radius_mm, 10.75, 0.1);
        EXPECT_NEAR(std::abs(rim.axis.z()), 1.0, 1e-6);
        const double off = rim.centre_mm.head<2>().norm();
        legs += std::abs(off - 23.0) < 0.23 ? 1 : 0;
        EXPECT_TRUE(off < 0.1 || std::abs(off - 23.0) < 0.23);
    }
    EXPECT_EQ(legs, 4);
}

TEST(LoadMandrel, CapsuleWithSeamIsClosedAndRound) {
    const Mandrel m = load_mandrel(mesh_file("vessel_capsule_seam_degenerate.obj"));
    EXPECT_TRUE(m.rims.empty());
    EXPECT_EQ(m.repairs.degenerate_faces_removed, 200);
    EXPECT_EQ(m.axis.rule, "revolution");
    EXPECT_EQ(m.unit_mm, 1000.0);
    EXPECT_NEAR(m.file_to_mandrel.linear().row(2).normalized().z(), 1.0, 1e-6);
    for (const auto& face : m.surface.neighbour) {
        EXPECT_EQ(std::count(face.begin(), face.end(), kNoFace), 0);
    }
}

}  // namespace
}  // namespace meshwind
