#include "winding/laminate/footprint.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "geodesic/trace.h"
#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

constexpr double kBand_mm = 8.0;
constexpr double kRadius_mm = 40.0;

struct Scene {
    Scene(double radius_mm, double length_mm, double edge_mm)
        : mandrel(test::made_cylinder(radius_mm, length_mm, edge_mm)),
          samples(sample_surface(mandrel.surface, 1.5, 1)),
          finder(mandrel.surface, samples, kBand_mm) {}

    // From the middle of a facet near z = 0, at an angle to the spindle.
    [[nodiscard]] SurfacePath helix(double angle_rad, double length_mm) const {
        const Surface& s = mandrel.surface;
        SurfacePoint start{0};
        for (std::int32_t f = 0; f < static_cast<std::int32_t>(s.face.size()); ++f) {
            if (std::abs(position_mm(s, {f}).z()) < std::abs(position_mm(s, start).z())) {
                start.face = f;
            }
        }
        const Eigen::Vector3d axial = Eigen::Vector3d::UnitZ();
        const Eigen::Vector3d around = axial.cross(smooth_normal(s, start));
        return trace(s, start, std::cos(angle_rad) * axial + std::sin(angle_rad) * around, {},
                     {.max_length_mm = length_mm})
            .path;
    }

    [[nodiscard]] std::vector<std::int32_t> footprint(const SurfacePath& path) const {
        FootprintFinder::Scratch scratch = finder.make_scratch();
        return finder.footprint(path, scratch);
    }

    Mandrel mandrel;
    CoverageSamples samples;
    FootprintFinder finder;
};

// The samples are far more even than chance: their number in a strip is good to its rim, a few per
// cent of a band of five samples' width.
TEST(Footprint, OfAHelixIsBandTimesLength) {
    const Scene scene(kRadius_mm, 300.0, 5.0);
    for (const double angle : {0.0, 0.4, 0.9}) {
        const SurfacePath path = scene.helix(angle, 120.0);
        ASSERT_NEAR(path.back().s_mm, 120.0, 1e-9);
        const auto found = scene.footprint(path);
        const double area = static_cast<double>(found.size()) * scene.samples.area_mm2;
        EXPECT_NEAR(area / (kBand_mm * 120.0), 1.0, 0.05) << "angle " << angle;
    }
}

TEST(Footprint, LiesWithinHalfABandOfThePath) {
    const Scene scene(kRadius_mm, 300.0, 5.0);
    const SurfacePath path = scene.helix(0.7, 150.0);
    for (const std::int32_t sample : scene.footprint(path)) {
        double nearest = 1e9;
        for (const PathPoint& p : path) {
            nearest = std::min(
                nearest,
                (p.position_mm - scene.samples.position_mm[static_cast<std::size_t>(sample)])
                    .norm());
        }
        ASSERT_LT(nearest, std::hypot(0.5 * kBand_mm, 5.0)) << "stations are at most an edge apart";
    }
}

TEST(Footprint, ListsASecondPassAgain) {
    const Scene scene(kRadius_mm, 120.0, 5.0);
    const double turn = 2.0 * kPi * kRadius_mm;
    const auto found = scene.footprint(scene.helix(0.5 * kPi, 2.0 * turn));
    std::map<std::int32_t, int> passes;
    for (const std::int32_t sample : found) {
        ++passes[sample];
    }
    const auto twice =
        std::count_if(passes.begin(), passes.end(), [](const auto& p) { return p.second == 2; });
    // The second turn comes back to the first but for the error of the trace.
    EXPECT_GT(static_cast<double>(twice), 0.95 * static_cast<double>(passes.size()));
    EXPECT_NEAR(
        static_cast<double>(found.size()) * scene.samples.area_mm2 / (2.0 * turn * kBand_mm), 1.0,
        0.05);
}

TEST(Footprint, NeverCoversTheOppositeWall) {
    const Scene scene(1.5, 60.0, 0.8);  // its diameter is less than half a band
    const SurfacePath path = scene.helix(0.0, 20.0);
    const auto found = scene.footprint(path);
    ASSERT_FALSE(found.empty());
    for (const std::int32_t sample : found) {
        ASSERT_GT(scene.samples.normal[static_cast<std::size_t>(sample)].dot(path.front().normal),
                  0.0);
    }
}

TEST(Footprint, LeavesItsScratchAsItFoundIt) {
    const Scene scene(kRadius_mm, 120.0, 5.0);
    FootprintFinder::Scratch scratch = scene.finder.make_scratch();
    const SurfacePath path = scene.helix(0.7, 60.0);
    const auto first = scene.finder.footprint(path, scratch);
    EXPECT_EQ(scene.finder.footprint(path, scratch), first);
    EXPECT_TRUE(scene.finder.footprint({}, scratch).empty());
}

}  // namespace
}  // namespace meshwind
