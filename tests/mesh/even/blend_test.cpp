// Crotches and steps filled up. What a rolling ball leaves is the made tee's own blend.
#include "mesh/even/blend.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/mesh_measures.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

TriangleSoup tee(double blend_mm, double edge_mm) {
    return make_mandrel("tee", {{"blend-radius", blend_mm}}, {.edge_mm = edge_mm});
}

// The smooth surface lies a little deeper in the crotch than the ball's.
TEST(Blend, FillsTheCrotchOfATeeAsABallDoes) {
    const Mandrel blended = build_mandrel(tee(0.5, 5.0), "sharp", {.blend_mm = 15.0});
    const double by_ball =
        test::measure(tee(15.0, 3.0)).volume_mm3 - test::measure(tee(0.5, 3.0)).volume_mm3;
    EXPECT_GT(blended.winding_mesh.filled_mm3, 0.6 * by_ball);
    EXPECT_LT(blended.winding_mesh.filled_mm3, 1.1 * by_ball);
    // Far from it nothing has moved.
    for (const Vector3d& p : blended.surface.position_mm) {
        if (std::abs(p.z()) > 80.0) {
            EXPECT_NEAR(p.head<2>().norm(), 50.0, 5e-3);
        } else if (p.x() > 100.0) {
            EXPECT_NEAR(std::hypot(p.y(), p.z()), 40.0, 5e-3);
        }
    }
    ASSERT_EQ(blended.rims.size(), 3U);
    EXPECT_EQ(blended.axis.rule, "coaxial-rims");
}

// A pipe of 20 mm with a collar of 24 mm: the ramp leads from the one to the other, and neither
// crease is left.
TEST(Blend, MakesARampOfAStep) {
    const TriangleSoup soup = test::revolve(
        {{20, 0}, {20, 20}, {20, 40}, {20, 60}, {24, 60}, {24, 80}, {24, 100}, {24, 120}}, 64);
    const Mandrel step = build_mandrel(soup, "step", {.blend_mm = 10.0});
    EXPECT_GT(step.winding_mesh.filled_mm3, 0.0);
    double lowest = 90.0;
    for (const Vector3d& p : step.surface.position_mm) {
        const double radius = p.head<2>().norm();
        EXPECT_GT(radius, 20.0 - 0.1);
        EXPECT_LT(radius, 24.0 + 0.5);
        if (radius > 20.2) {
            lowest = std::min(lowest, p.z());
        }
    }
    // A ball of 10 mm that touches the pipe and the edge 4 mm over it touches the pipe 8 mm before.
    EXPECT_LT(lowest, -3.0);
    EXPECT_GT(lowest, -8.5);
    // Of the creases that of the edge is left, on which the ball rests.
    int edges = 0;
    for (std::size_t f = 0; f < step.surface.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            if (step.surface.feature[f][e] != 0) {
                const auto v = static_cast<std::size_t>(step.surface.face[f][e]);
                EXPECT_NEAR(step.surface.position_mm[v].head<2>().norm(), 24.0, 0.01);
                ++edges;
            }
        }
    }
    EXPECT_GT(edges, 0);
}

TEST(Blend, LeavesAWallThatTheBallTouches) {
    const TriangleSoup soup = make_mandrel("elbow", {}, {.edge_mm = 6.0});
    const Mandrel before = build_mandrel(soup, "elbow");
    const Mandrel after = build_mandrel(soup, "elbow", {.blend_mm = 10.0});
    EXPECT_EQ(after.surface.position_mm, before.surface.position_mm);
    EXPECT_EQ(after.winding_mesh.blended_mm2, 0.0);
}

}  // namespace
}  // namespace meshwind
