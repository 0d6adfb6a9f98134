#include "mesh/mandrel/thicken.h"
#include "mesh/mandrel/load_mandrel.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

Mandrel made(const char* kind, const MakeValues& values, double edge_mm) {
    return build_mandrel(make_mandrel(kind, values, {.edge_mm = edge_mm}), kind);
}

std::vector<double> even(const Mandrel& mandrel, double thickness_mm) {
    return std::vector<double>(mandrel.surface.position_mm.size(), thickness_mm);
}

// Normals at edges of 6 mm on a radius of 40 are off by 1e-3 rad, and the thickness by half of the
// square of that.
constexpr double kByNormals_mm = 1e-6;

TEST(Thicken, ACylinderStaysOne) {
    const Mandrel pipe = made("cylinder", {{"radius", 40.0}, {"length", 120.0}}, 6.0);
    const Mandrel grown = thicken(pipe, even(pipe, 1.5));
    ASSERT_EQ(grown.rims.size(), 2U);
    EXPECT_NEAR(grown.rims[0].radius_mm, 41.5, kByNormals_mm);
    EXPECT_NEAR(grown.rims[0].centre_mm.z(), pipe.rims[0].centre_mm.z(), 2e-3);
    for (const Vector3d& p : grown.surface.position_mm) {
        EXPECT_NEAR(std::hypot(p.x(), p.y()), 41.5, kByNormals_mm);
    }
    EXPECT_TRUE(grown.file_to_mandrel.isApprox(pipe.file_to_mandrel, 1e-12));
}

// x^2 / a^2 + .. of an ellipsoid with something on it: every grown vertex is as far from the old
// surface as it was moved, along the true normal.
TEST(Thicken, MovesAlongTheNormals) {
    const Mandrel body = made("ellipsoid", {{"equator-radius", 50.0}, {"pole-radius", 70.0}}, 5.0);
    const double thickness = 2.0;
    const Mandrel grown = thicken(body, even(body, thickness));
    for (std::size_t v = 0; v < body.surface.position_mm.size(); ++v) {
        const Vector3d& p = body.surface.position_mm[v];
        const Vector3d normal =
            Vector3d(p.x() / (50.0 * 50.0), p.y() / (50.0 * 50.0), p.z() / (70.0 * 70.0))
                .normalized();
        const Vector3d moved = grown.surface.position_mm[v] - p;
        // Normals of the mesh are off by fourth order: 1e-3 rad at edges of a tenth of the radius.
        EXPECT_NEAR(moved.dot(normal), thickness, 1e-6);
        EXPECT_LT((moved - thickness * normal).norm(), thickness * 1e-3);
    }
}

// At a sharp edge both sides move by their thickness.
TEST(Thicken, MovesBothSidesOfAnEdge) {
    const Mandrel body = made("combination", {}, 6.0);
    const double thickness = 1.0;
    const Mandrel grown = thicken(body, even(body, thickness));
    const Surface& before = body.surface;
    const Surface& after = grown.surface;
    int at_edges = 0;
    for (std::size_t f = 0; f < before.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (before.feature[f][e] == 0) {
                continue;
            }
            const auto v = static_cast<std::size_t>(before.face[f][e]);
            const auto corner = static_cast<std::size_t>(before.corner[f][e]);
            const Vector3d moved = after.position_mm[v] - before.position_mm[v];
            EXPECT_NEAR(moved.dot(before.normal[corner]), thickness, 0.02);
            ++at_edges;
        }
    }
    EXPECT_GT(at_edges, 100);
}

TEST(Thicken, RefusesToFoldAHollow) {
    const Mandrel tee =
        made("tee", {{"run-radius", 50.0}, {"branch-radius", 40.0}, {"blend-radius", 6.0}}, 4.0);
    EXPECT_NO_THROW((void)thicken(tee, even(tee, 2.0)));
    try {
        (void)thicken(tee, even(tee, 9.0));
        FAIL() << "9 mm in a hollow of 6 mm";
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), "thicken.folds");
        EXPECT_TRUE(test::tells(error.what(), "9.00 mm")) << error.what();
    }
}

}  // namespace
}  // namespace meshwind
