#include "geodesic/lifted_wall.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/shapes/make.h"
#include "tests/support/frozen.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kRing_mm = 200.0;
constexpr double kTube_mm = 50.0;
constexpr double kEdge_mm = 10.0;

// Of the patches, fifth order: (10 / 50)^5 of the radius would be 0.016 mm, a fit's constant is
// below a tenth.
constexpr double kPatch_mm = 0.002;

double height_over_torus_mm(const Vector3d& p) {
    return std::hypot(p.head<2>().norm() - kRing_mm, p.z()) - kTube_mm;
}

// Least height over the torus along a segment, looked at every 0.05 mm.
double least_height_mm(const Vector3d& from, const Vector3d& to) {
    const int steps = static_cast<int>((to - from).norm() / 0.05) + 1;
    double least = height_over_torus_mm(from);
    for (int i = 1; i <= steps; ++i) {
        least = std::min(least, height_over_torus_mm(from + (to - from) * i / steps));
    }
    return least;
}

TEST(LiftedWall, TellsWhatPassesOverATorusAndNothingElse) {
    const Surface torus =
        test::frozen(make_torus({.ring_radius_mm = kRing_mm, .tube_radius_mm = kTube_mm},
                                {.edge_mm = kEdge_mm, .irregular = true}));
    const LiftedWall lifted(torus);
    // Edges of up to twice their length over the tube: twice a sag of 1 mm, from both sides.
    EXPECT_LT(lifted.height_mm(), 4.0);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    int free = 0;
    int touching = 0;
    int grazing =
        0;  // between the facets and the patches over them, where facets alone tell nothing
    for (int i = 0; i < 4000; ++i) {
        const double u = 2.0 * kPi * unit(random);
        const double v = 2.0 * kPi * unit(random);
        const Vector3d outward(std::cos(u), std::sin(u), 0.0);
        const Vector3d normal = std::cos(v) * outward + std::sin(v) * Vector3d::UnitZ();
        const Vector3d around(-std::sin(u), std::cos(u), 0.0);
        const double angle = 2.0 * kPi * unit(random);
        const Vector3d tangent = std::cos(angle) * around + std::sin(angle) * normal.cross(around);
        const Vector3d from =
            kRing_mm * outward + (kTube_mm + 2.0 * lifted.height_mm() * unit(random)) * normal;
        const Vector3d to = from + 60.0 * (tangent + 0.3 * (unit(random) - 0.7) * normal);
        const double least_mm = least_height_mm(from, to);
        const bool is_free = lifted.is_free(from, to);
        if (is_free) {
            EXPECT_GT(least_mm, -kPatch_mm);
        }
        if (least_mm > 1.5 * lifted.height_mm()) {
            EXPECT_TRUE(is_free);
        }
        free += is_free ? 1 : 0;
        touching += least_mm < 0.0 ? 1 : 0;
        grazing += least_mm < 0.0 && least_mm > -0.1 ? 1 : 0;
    }
    EXPECT_GT(free, 400);
    EXPECT_GT(touching, 400);
    EXPECT_GT(grazing, 10);
}

}  // namespace
}  // namespace meshwind
