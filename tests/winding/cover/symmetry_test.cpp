#include "winding/cover/symmetry.h"
#include "tests/support/course_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using test::CourseScene;

constexpr double kTolerance_mm = 1.0;

std::size_t images_of(const Mandrel& mandrel) {
    const CourseScene scene(mandrel, 0.25);
    return MirrorImages(scene.mandrel, scene.samples, kTolerance_mm).size();
}

Mandrel lateral() {
    return test::made("tee",
                      {{"run-radius", 30.0},
                       {"branch-radius", 20.0},
                       {"blend-radius", 10.0},
                       {"run-length", 240.0},
                       {"branch-length", 130.0},
                       {"lean", 0.4}},
                      5.0);
}

TEST(MirrorImages, AreAsManyAsPlanesAllow) {
    EXPECT_EQ(images_of(test::small_tee(4.0)), 3U) << "two planes, and both";
    EXPECT_EQ(images_of(lateral()), 1U);
    EXPECT_EQ(images_of(test::made("elbow", {}, 8.0)), 3U);
    EXPECT_GE(images_of(test::made_cylinder(30.0, 160.0, 6.0)), 7U);
    // A cone has no counterpart in the direction of its axis.
    EXPECT_EQ(images_of(test::made("cone", {}, 4.0)), 3U);
}

TEST(MirrorImages, AreNoneOnceABumpStandsOnTheWall) {
    Mandrel mandrel = lateral();
    CourseScene scene(mandrel, 0.25);
    // Samples alone decide: some that stand off the wall on one side.
    for (std::size_t i = 0; i < scene.samples.size(); ++i) {
        Vector3d& position = scene.samples.position_mm[i];
        if ((position - Vector3d(30.0, 0.0, -60.0)).norm() < 15.0 ||
            (position - Vector3d(0.0, 30.0, -60.0)).norm() < 25.0) {
            position += 3.0 * scene.samples.normal[i];
        }
    }
    EXPECT_EQ(MirrorImages(scene.mandrel, scene.samples, kTolerance_mm).size(), 0U);
}

// Where the ideal tee of the mesh lies on its own image.
Vector3d folded(const Vector3d& position) {
    return {position.x(), std::abs(position.y()), std::abs(position.z())};
}

// 80 mm from their seeds a course and its image are at places that are images of each other, to
// what the mesh is unlike its own image.
TEST(MirrorImages, RunWhereTheImageOfTheCourseRuns) {
    const CourseScene scene(test::small_tee(3.0), 0.25);
    const Surface& surface = scene.mandrel.surface;
    const MirrorImages images(scene.mandrel, scene.samples, kTolerance_mm);
    ASSERT_EQ(images.size(), 3U);
    const auto end_of = [&](const Candidate& candidate) {
        const TraceResult run = trace(surface, candidate.seed, direction_of(surface, candidate),
                                      {candidate.slip_ratio, 0.0}, {.max_length_mm = 80.0});
        return run.stop == TraceStop::Length ? std::optional(run.path.back().position_mm)
                                             : std::nullopt;
    };
    std::vector<double> off_mm;
    for (const Candidate& candidate : scene.candidates(100, 3, 0.6)) {
        const auto end = end_of(candidate);
        for (std::size_t which = 0; which < images.size(); ++which) {
            if (const auto other = end_of(images.of(candidate, which)); end && other) {
                off_mm.push_back((folded(*other) - folded(*end)).norm());
            }
        }
    }
    ASSERT_GT(off_mm.size(), 100U);
    std::sort(off_mm.begin(), off_mm.end());
    EXPECT_LT(off_mm[off_mm.size() / 2], 0.1);
    EXPECT_LT(off_mm[off_mm.size() * 9 / 10], 1.0);
}

}  // namespace
}  // namespace meshwind
