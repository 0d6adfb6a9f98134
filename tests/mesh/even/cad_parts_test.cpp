// Parts as a CAD program tessellates them: one row of long facets along each pipe. The figures are
// those the parts were drawn with (data/README.md).
#include <cmath>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/revolution/revolution.h"
#include "mesh/tube/tube.h"

namespace meshwind {
namespace {

Mandrel part(const std::string& name, MandrelOptions::Mesh mesh = MandrelOptions::Mesh::Even) {
    return load_mandrel(std::string(MESHWIND_SOURCE_DIR) + "/data/meshes/cad/" + name + ".stl",
                        {.mesh = mesh});
}

TEST(CadParts, ElbowIsATubeOfItsThreeParts) {
    const Mandrel mandrel = part("elbow");
    ASSERT_TRUE(mandrel.winding_mesh.own);
    EXPECT_LT(mandrel.winding_mesh.deviation_mm, 0.005);
    const TubeFinding found = find_tube(mandrel);
    ASSERT_TRUE(found.tube) << found.why_not;
    const auto& parts = found.tube->parts;
    ASSERT_EQ(parts.size(), 3U);
    const bool long_first = parts[0].to_mm - parts[0].from_mm > 50.0;
    EXPECT_NEAR(parts[long_first ? 0 : 2].to_mm - parts[long_first ? 0 : 2].from_mm, 85.0, 0.05);
    EXPECT_NEAR(parts[long_first ? 2 : 0].to_mm - parts[long_first ? 2 : 0].from_mm, 30.0, 0.05);
    EXPECT_NEAR(parts[1].bend_radius_mm, 26.0, 0.05);
    EXPECT_NEAR(deg_from_rad(parts[1].angle_rad), 90.0, 0.1);
    EXPECT_NEAR(found.tube->radius_at(10.0), 14.0, 0.005);
}

// Bore, lips, tabs, letters and metres are told apart from the elbow.
TEST(CadParts, ElbowWithLettersLipsAndTabsIsATube) {
    const Mandrel mandrel =
        load_mandrel(std::string(MESHWIND_SOURCE_DIR) + "/data/meshes/cad/lettered_elbow.stl",
                     {.unit_mm = 1000.0});
    EXPECT_EQ(mandrel.winding_mesh.details, 2);
    EXPECT_LT(mandrel.winding_mesh.deviation_mm, 0.005);
    ASSERT_EQ(mandrel.rims.size(), 2U);
    for (const Rim& rim : mandrel.rims) {
        EXPECT_NEAR(rim.radius_mm, 13.3756, 1e-3);
        EXPECT_GT(rim.cut_off_mm, 0.0);
    }
    const TubeFinding found = find_tube(mandrel);
    ASSERT_TRUE(found.tube) << found.why_not;
    ASSERT_EQ(found.tube->parts.size(), 3U);
    EXPECT_NEAR(deg_from_rad(found.tube->parts[1].angle_rad), 31.204, 0.1);
    EXPECT_NEAR(found.tube->radius_at(10.0), 13.3756, 0.005);
}

// The same file wound on its own triangles is no tube at all.
TEST(CadParts, ElbowOnTheFilesTrianglesIsNone) {
    const Mandrel mandrel = part("elbow", MandrelOptions::Mesh::File);
    EXPECT_FALSE(mandrel.winding_mesh.own);
    EXPECT_FALSE(find_tube(mandrel).tube);
}

TEST(CadParts, VesselHasItsDomesAndCylinders) {
    const Mandrel mandrel = part("vessel");
    ASSERT_TRUE(mandrel.winding_mesh.own);
    const RevolutionFinding found = find_revolution(mandrel);
    ASSERT_TRUE(found.body) << found.why_not;
    const auto& parts = found.body->parts;
    ASSERT_EQ(parts.size(), 5U);
    const double nozzle_mm = 150.0 - 75.0 - std::sqrt(60.0 * 60.0 - 15.0 * 15.0);
    const double dome_mm = 60.0 * (kPi / 2.0 - std::asin(15.0 / 60.0));
    const double lengths_mm[] = {nozzle_mm, dome_mm, 150.0, dome_mm, nozzle_mm};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_NEAR(parts[i].to_mm - parts[i].from_mm, lengths_mm[i], 0.1) << i;
    }
    EXPECT_NEAR(parts[2].radius_mm, 60.0, 1e-3);
    EXPECT_LT(found.body->residual_mm, 0.02);
}

TEST(CadParts, SteppedReducerHasItsCylinders) {
    const RevolutionFinding found = find_revolution(part("reducer"));
    ASSERT_TRUE(found.body) << found.why_not;
    ASSERT_EQ(found.body->parts.size(), 3U);
    EXPECT_EQ(found.body->parts[0].kind, MeridianPartKind::Cylinder);
    EXPECT_EQ(found.body->parts[1].kind, MeridianPartKind::Cone);
    EXPECT_EQ(found.body->parts[2].kind, MeridianPartKind::Cylinder);
    EXPECT_NEAR(found.body->parts[0].radius_mm, 40.0, 1e-4);
    EXPECT_NEAR(found.body->parts[2].radius_mm, 25.0, 1e-4);
}

// Cylinders and cones with fillets of a millimetre between them, five rings of facets each, whose
// vertices around are fifteen times as far apart.
TEST(CadParts, FilletedReducerIsSweptWithItsFillets) {
    const Mandrel mandrel = part("filleted_reducer");
    EXPECT_TRUE(mandrel.winding_mesh.swept);
    EXPECT_LT(mandrel.winding_mesh.deviation_mm, 1e-3);
    const RevolutionFinding found = find_revolution(mandrel);
    ASSERT_TRUE(found.body) << found.why_not;
    using enum MeridianPartKind;
    const MeridianPartKind kinds[] = {Cylinder, Dome, Cone, Dome,    Cylinder,
                                      Dome,     Cone, Dome, Cylinder};
    ASSERT_EQ(found.body->parts.size(), std::size(kinds));
    for (std::size_t i = 0; i < std::size(kinds); ++i) {
        EXPECT_EQ(found.body->parts[i].kind, kinds[i]) << i;
    }
    EXPECT_NEAR(found.body->parts[0].radius_mm, 23.541, 1e-3);
    EXPECT_NEAR(found.body->parts[8].radius_mm, 12.444, 1e-3);
    EXPECT_LT(found.body->residual_mm, 1e-3);
    EXPECT_EQ(mandrel.surface.fit.averaged, 0U);
}

// Even triangles of the first size come only within 0.16 mm of the file's vertices.
TEST(CadParts, VesselWithANozzleHasShorterEdgesWhereItNeedsThem) {
    const Mandrel mandrel = part("vessel_with_nozzle");
    ASSERT_TRUE(mandrel.winding_mesh.own) << mandrel.winding_mesh.why_not;
    EXPECT_LE(mandrel.winding_mesh.deviation_mm, 0.1208);
    ASSERT_EQ(mandrel.rims.size(), 3U);
}

// Off the blend the legs are cylinders: vertices and normals are theirs to fourth and third order.
TEST(CadParts, LegsOfTheTeeAreCylinders) {
    const Mandrel mandrel = part("tee");
    ASSERT_TRUE(mandrel.winding_mesh.own);
    ASSERT_EQ(mandrel.rims.size(), 3U);
    const Surface& surface = mandrel.surface;
    double off = 0.0;
    double turned = 0.0;
    std::size_t seen = 0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
            const Eigen::Vector3d& p =
                surface.position_mm[static_cast<std::size_t>(surface.face[f][c])];
            if (std::abs(p.z()) < 90.0 || std::abs(p.z()) > 190.0) {
                continue;
            }
            const Eigen::Vector3d& n =
                surface.normal[static_cast<std::size_t>(surface.corner[f][c])];
            const Eigen::Vector3d out = Eigen::Vector3d(p.x(), p.y(), 0.0).normalized();
            off = std::max(off, std::abs(p.head<2>().norm() - 50.0));
            turned = std::max(turned, n.cross(out).norm());
            ++seen;
        }
    }
    EXPECT_GT(seen, 10000U);
    EXPECT_LT(off, 0.003);
    EXPECT_LT(turned, rad_from_deg(0.1));
}

}  // namespace
}  // namespace meshwind
