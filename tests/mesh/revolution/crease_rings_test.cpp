#include "mesh/revolution/crease_rings.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/shapes/make.h"

namespace meshwind {
namespace {

struct Ring {
    double z_mm;
    double turn_rad;
};

// Feature edges by height, each met from both faces.
std::vector<Ring> rings_of(const Surface& surface) {
    std::vector<Ring> rings;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (surface.feature[f][e] == 0) {
                continue;
            }
            const auto& a = surface.position_mm[static_cast<std::size_t>(surface.face[f][e])];
            const auto& b =
                surface.position_mm[static_cast<std::size_t>(surface.face[f][(e + 1) % 3])];
            EXPECT_NEAR(a.z(), b.z(), 1e-9);
            const double turn = std::abs(
                std::remainder(std::atan2(a.y(), a.x()) - std::atan2(b.y(), b.x()), 2.0 * kPi));
            const auto ring = std::find_if(rings.begin(), rings.end(), [&](const Ring& r) {
                return std::abs(r.z_mm - a.z()) < 1e-6;
            });
            if (ring == rings.end()) {
                rings.push_back({a.z(), 0.5 * turn});
            } else {
                ring->turn_rad += 0.5 * turn;
            }
        }
    }
    return rings;
}

// Both ends of its cone are creases of 18 deg, which no dihedral of a single edge tells.
TEST(CreaseRings, OfACombinationAreFeatures) {
    const CombinationShape shape;
    const Mandrel mandrel = build_mandrel(make_combination(shape), "made.stl");
    std::vector<Ring> rings = rings_of(mandrel.surface);
    ASSERT_EQ(rings.size(), 2U);
    std::sort(rings.begin(), rings.end(),
              [](const Ring& a, const Ring& b) { return a.z_mm < b.z_mm; });
    EXPECT_NEAR(rings[1].z_mm - rings[0].z_mm, shape.cone_length_mm, 1e-6);
    for (const Ring& ring : rings) {
        EXPECT_NEAR(ring.turn_rad, 2.0 * kPi, 1e-9);
    }
    // So that normals are those of cylinder and cone up to the edge.
    const double lean = std::atan2(shape.radius1_mm - shape.radius2_mm, shape.cone_length_mm);
    const Surface& surface = mandrel.surface;
    double worst = 0.0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const auto& p = surface.position_mm[static_cast<std::size_t>(surface.face[f][e])];
            if (std::abs(p.z() - rings[0].z_mm) > 1e-6) {
                continue;
            }
            double top = p.z();
            for (const std::int32_t v : surface.face[f]) {
                top = std::max(top, surface.position_mm[static_cast<std::size_t>(v)].z());
            }
            const double nz = surface.normal[static_cast<std::size_t>(surface.corner[f][e])].z();
            worst = std::max(worst, std::abs(nz - (top > p.z() + 1e-6 ? std::sin(lean) : 0.0)));
        }
    }
    EXPECT_LT(worst, 2e-3);
}

TEST(CreaseRings, SmoothBodiesHaveNone) {
    EXPECT_TRUE(rings_of(build_mandrel(make_vessel({}), "made.stl").surface).empty());
    EXPECT_TRUE(rings_of(build_mandrel(make_cone({}), "made.stl").surface).empty());
    EXPECT_TRUE(rings_of(build_mandrel(make_tee({}), "made.stl").surface).empty());
}

TEST(CreaseRings, KinksOfLessThanADegreeStaySmooth) {
    CombinationShape shape;
    shape.radius2_mm = shape.radius1_mm - 0.9 * std::tan(rad_from_deg(1.0)) * shape.cone_length_mm;
    EXPECT_TRUE(rings_of(build_mandrel(make_combination(shape), "made.stl").surface).empty());
    shape.radius2_mm = shape.radius1_mm - 1.1 * std::tan(rad_from_deg(1.0)) * shape.cone_length_mm;
    EXPECT_EQ(rings_of(build_mandrel(make_combination(shape), "made.stl").surface).size(), 2U);
}

}  // namespace
}  // namespace meshwind
