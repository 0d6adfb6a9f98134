#include "geodesic/path_accuracy.h"

#include <cstdio>

#include <gtest/gtest.h>

#include "mesh/shapes/make_kinds.h"
#include "mesh/smooth/refine.h"
#include "tests/support/reference.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// A cylinder around z.
struct ExactCylinder {
    double radius_mm = 50.0;

    [[nodiscard]] Vector3d normal(const Vector3d& p) const {
        return Vector3d(p.x(), p.y(), 0.0).normalized();
    }
    [[nodiscard]] Vector3d foot(const Vector3d& p) const {
        return radius_mm * normal(p) + Vector3d(0.0, 0.0, p.z());
    }
    [[nodiscard]] Eigen::Matrix3d shape_operator_per_mm(const Vector3d& p) const {
        const Vector3d around = Vector3d::UnitZ().cross(normal(p));
        return around * around.transpose() / radius_mm;
    }
};

// True rms drift in mm per metre of 150 random geodesics: other starts than those of the estimate.
template <class Shape>
double true_drift(const Shape& shape, const Surface& surface, double length_mm,
                  TraceMethod method) {
    std::mt19937_64 random(7);
    double drift = 0.0;
    double length = 0.0;
    for (int i = 0; i < 150; ++i) {
        const test::Start start = test::random_start(surface, random);
        // Where the method lets the path begin.
        const Vector3d p =
            shape.foot(method == TraceMethod::Walk
                           ? position_mm(surface, start.at)
                           : on_patch(surface, start.at.face, start.at.bary).position_mm);
        const Vector3d n = shape.normal(p);
        const Vector3d t = (start.direction - n * n.dot(start.direction)).normalized();
        const PathPoint end =
            trace(surface, start.at, t, {}, {.max_length_mm = length_mm, .method = method})
                .path.back();
        if (end.s_mm < 3.0 * surface.mean_edge_mm) {
            continue;
        }
        const Vector3d exact = test::follow(shape, {p, t}, end.s_mm).position_mm;
        const Vector3d apart = end.position_mm - exact;
        const Vector3d up = shape.normal(exact);
        drift += (apart - up * up.dot(apart)).squaredNorm();
        length += end.s_mm * end.s_mm;
    }
    return 1e3 * std::sqrt(drift / length);
}

// The estimate is within a factor of 3 of the truth.
template <class Shape>
void expect_honest(const Shape& shape, const char* kind, const MakeValues& values,
                   double tube_radius_mm) {
    for (const bool irregular : {false, true}) {
        for (const double share : {5.0, 10.0, 20.0}) {
            const Surface surface = test::frozen(make_mandrel(
                kind, values, {.edge_mm = tube_radius_mm / share, .irregular = irregular}));
            const PathAccuracy estimate = estimate_path_accuracy(surface);
            const double walk = true_drift(shape, surface, estimate.length_mm, TraceMethod::Walk);
            const double patches =
                true_drift(shape, surface, estimate.length_mm, TraceMethod::Patches);
            std::printf(
                "%s %s r/%.0f, %zu triangles, %.0f mm: walk %.3g (true %.3g, %.2f), "
                "patches %.3g (true %.3g, %.2f) mm/m\n",
                kind, irregular ? "irregular" : "regular", share, surface.face.size(),
                estimate.length_mm, estimate.walk_mm_per_m, walk, estimate.walk_mm_per_m / walk,
                estimate.patches_mm_per_m, patches, estimate.patches_mm_per_m / patches);
            EXPECT_LT(estimate.walk_mm_per_m, 3.0 * walk);
            EXPECT_GT(estimate.walk_mm_per_m, walk / 3.0);
            EXPECT_LT(estimate.patches_mm_per_m, 3.0 * patches);
            EXPECT_GT(estimate.patches_mm_per_m, patches / 3.0);
        }
    }
}

TEST(PathAccuracy, HonestOnTori) {
    expect_honest(test::ExactTorus{}, "torus", {}, 50.0);
    expect_honest(test::ExactTorus{120.0, 40.0}, "torus",
                  {{"ring-radius", 120.0}, {"tube-radius", 40.0}}, 40.0);
}

TEST(PathAccuracy, HonestOnCylinders) {
    expect_honest(ExactCylinder{50.0}, "cylinder", {{"radius", 50.0}, {"length", 300.0}}, 50.0);
    expect_honest(ExactCylinder{20.0}, "cylinder", {{"radius", 20.0}, {"length", 200.0}}, 20.0);
}

// Half the edges, a quarter of the drift, although nothing was known but the coarse mesh.
TEST(PathAccuracy, WalksAreNearerToTheTruthOnARefinedMesh) {
    const auto expect_nearer = [](const auto& shape, const char* kind, const MakeValues& values) {
        const Surface coarse =
            test::frozen(make_mandrel(kind, values, {.edge_mm = 8.0, .irregular = true}));
        const Surface fine = refined(coarse, 0.5 * coarse.mean_edge_mm).frozen();
        const double before = true_drift(shape, coarse, 400.0, TraceMethod::Walk);
        const double after = true_drift(shape, fine, 400.0, TraceMethod::Walk);
        std::printf("%s: %.3g mm/m, refined %.3g mm/m\n", kind, before, after);
        EXPECT_LT(after, before / 3.0);
        EXPECT_LT(estimate_path_accuracy(fine).walk_mm_per_m,
                  estimate_path_accuracy(coarse).walk_mm_per_m / 3.0);
    };
    expect_nearer(test::ExactTorus{}, "torus", {});
    expect_nearer(ExactCylinder{50.0}, "cylinder", {{"radius", 50.0}, {"length", 300.0}});
}

TEST(PathAccuracy, NothingToSayWhereNoPathIsSomeEdgesLong) {
    const TriangleSoup square{{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}},
                              {{0, 1, 2}, {0, 2, 3}}};
    EXPECT_EQ(estimate_path_accuracy(test::frozen(square)).paths, 0);
}

TEST(PathAccuracy, FlatSurfacesAreExact) {
    TriangleSoup grid;
    for (int i = 0; i < 21; ++i) {
        for (int j = 0; j < 21; ++j) {
            grid.points_mm.emplace_back(5.0 * i, 5.0 * j, 0.0);
            const int a = 21 * i + j;
            if (i < 20 && j < 20) {
                grid.faces.push_back({a, a + 21, a + 22});
                grid.faces.push_back({a, a + 22, a + 1});
            }
        }
    }
    const PathAccuracy accuracy = estimate_path_accuracy(test::frozen(grid));
    EXPECT_GT(accuracy.paths, 20);
    // Rounding of coordinates of 100 mm at a hundred crossings.
    EXPECT_LT(accuracy.walk_mm_per_m, 1e-9);
    EXPECT_LT(accuracy.patches_mm_per_m, 1e-9);
}

TEST(EstimatePathAccuracy, IsNoneOfASurfaceWithoutTriangles) {
    EXPECT_EQ(estimate_path_accuracy(Surface{}).paths, 0);
}

}  // namespace
}  // namespace meshwind
