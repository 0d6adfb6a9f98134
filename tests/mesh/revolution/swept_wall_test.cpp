#include "mesh/revolution/swept_wall.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/even/slivers.h"
#include "mesh/even/winding_mesh.h"
#include "tests/support/mesh_measures.h"

namespace meshwind {
namespace {

// A quarter of a circle of this radius about (0, z) from the axis to the equator, or back.
void append_dome(double radius_mm, double z_mm, bool lower, std::vector<MeridianNode>& nodes) {
    constexpr int kSteps = 12;
    for (int i = 0; i <= kSteps; ++i) {
        const double angle = 0.5 * kPi * (lower ? i - kSteps : i) / kSteps;
        nodes.push_back({.radius_mm = i == (lower ? 0 : kSteps) ? 0.0 : radius_mm * std::cos(angle),
                         .z_mm = z_mm + radius_mm * std::sin(angle)});
    }
}

double worst_off_mm(const LabelledMesh& mesh, const Meridian& meridian) {
    double off = 0.0;
    for (const Eigen::Vector3d& p : mesh.soup.points_mm) {
        off = std::max(off, meridian.foot(p.head<2>().norm(), p.z()).distance_mm);
    }
    return off;
}

// Two half balls and a pipe: closed, and as large as they are to second order in the edges.
TEST(SweptWall, OfACapsuleIsClosedAndHoldsItsVolume) {
    std::vector<MeridianNode> nodes;
    append_dome(40.0, -60.0, true, nodes);
    nodes.back().straight = true;
    append_dome(40.0, 60.0, false, nodes);
    const Meridian meridian(nodes);
    const double volume = kPi * 40.0 * 40.0 * (120.0 + 4.0 / 3.0 * 40.0);
    std::vector<double> missing;
    for (const double size_mm : {20.0, 10.0}) {  // edges of 3 and 1.5 mm
        const LabelledMesh mesh = swept_wall(meridian, size_mm);
        const test::MeshMeasures measures = test::measure(mesh.soup);
        EXPECT_TRUE(measures.oriented_manifold);
        EXPECT_EQ(measures.rims, 0);
        EXPECT_EQ(measures.euler, 2);
        EXPECT_LT(worst_off_mm(mesh, meridian), 1e-9);
        EXPECT_GT(least_quality(mesh.soup), 0.5);
        missing.push_back(volume - measures.volume_mm3);
    }
    EXPECT_GT(missing[1], 0.0);
    EXPECT_NEAR(std::log2(missing[0] / missing[1]), 2.0, 0.2);
}

TEST(SweptWall, OfAWireIsEmpty) {
    EXPECT_TRUE(swept_wall(Meridian({{1.0, 0.0}, {1.0, 1e6}}), 100.0).soup.faces.empty());
    EXPECT_TRUE(swept_wall(Meridian({{1.0, 0.0}, {1.0, 1e9}}), 100.0).soup.faces.empty());
}

// Fillets of a millimetre have rows of their own; between creases it is one region.
TEST(SweptWall, HasRowsOnFilletsAndRingsOnCreases) {
    std::vector<MeridianNode> nodes{{.radius_mm = 30.0, .z_mm = 0.0, .straight = true}};
    constexpr int kSteps = 4;
    for (int i = 0; i <= kSteps; ++i) {
        const double angle = rad_from_deg(45.0) * i / kSteps;
        nodes.push_back({.radius_mm = 29.0 + std::cos(angle), .z_mm = 100.0 + std::sin(angle)});
    }
    nodes.back().straight = true;
    nodes.push_back({.radius_mm = nodes.back().radius_mm - 10.0,
                     .z_mm = nodes.back().z_mm + 10.0,
                     .crease = true,
                     .straight = true});
    nodes.push_back({.radius_mm = nodes.back().radius_mm, .z_mm = 200.0});
    const Meridian meridian(nodes);
    const LabelledMesh mesh = swept_wall(meridian, 50.0);
    const test::MeshMeasures measures = test::measure(mesh.soup);
    EXPECT_TRUE(measures.oriented_manifold);
    EXPECT_EQ(measures.rims, 2);
    EXPECT_LT(worst_off_mm(mesh, meridian), 1e-9);
    EXPECT_GT(least_quality(mesh.soup), kUnevenQuality);
    std::vector<double> heights_mm;  // of rings on the fillet
    for (const Eigen::Vector3d& p : mesh.soup.points_mm) {
        if (p.z() > 100.001 && p.z() < 100.0 + std::sin(rad_from_deg(45.0)) - 0.001) {
            heights_mm.push_back(p.z());
        }
    }
    std::sort(heights_mm.begin(), heights_mm.end());
    const auto apart = [](double a, double b) { return b - a < 1e-9; };
    heights_mm.erase(std::unique(heights_mm.begin(), heights_mm.end(), apart), heights_mm.end());
    EXPECT_GE(heights_mm.size(), 2U);
    int on_crease = 0;
    for (std::size_t f = 0; f < mesh.soup.faces.size(); ++f) {
        double middle_mm = 0.0;
        for (std::size_t e = 0; e < 3; ++e) {
            const Eigen::Vector3d& a = test::point_of(mesh.soup, mesh.soup.faces[f][e]);
            const Eigen::Vector3d& b = test::point_of(mesh.soup, mesh.soup.faces[f][(e + 1) % 3]);
            middle_mm += a.z() / 3.0;
            if (mesh.feature[f][e] != 0) {
                ++on_crease;
                EXPECT_NEAR(a.z(), nodes[6].z_mm, 1e-9);
                EXPECT_NEAR(b.z(), nodes[6].z_mm, 1e-9);
            }
        }
        EXPECT_EQ(mesh.region[f], middle_mm < nodes[6].z_mm ? 0 : 1);
    }
    EXPECT_GT(on_crease, 2 * 8);
}

}  // namespace
}  // namespace meshwind
