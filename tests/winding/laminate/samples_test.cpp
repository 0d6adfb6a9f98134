#include "winding/laminate/samples.h"
#include "geodesic/on_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

constexpr double kSpacing_mm = 3.0;

const Surface& wall() {
    static const Mandrel mandrel = test::made_cylinder(20.0, 80.0, 4.0);
    return mandrel.surface;
}

TEST(SampleSurface, NoTwoSamplesAreNearerThanTheDisc) {
    const CoverageSamples samples = sample_surface(wall(), kSpacing_mm, 1);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            least = std::min(least, (samples.position_mm[i] - samples.position_mm[j]).norm());
        }
    }
    EXPECT_GE(least, 0.7 * kSpacing_mm);
}

TEST(SampleSurface, SharesOutTheWholeArea) {
    const CoverageSamples samples = sample_surface(wall(), kSpacing_mm, 1);
    EXPECT_NEAR(samples.area_mm2 * static_cast<double>(samples.size()), test::wall_area_mm2(wall()),
                1e-6);
    // Discs of 0.7 spacings at the density where darts saturate (share of area about 0.5).
    EXPECT_GT(samples.area_mm2, 0.5 * 0.49 * kSpacing_mm * kSpacing_mm);
    EXPECT_LT(samples.area_mm2, kSpacing_mm * kSpacing_mm);
}

TEST(SampleSurface, LiesOnTheWallWithItsNormals) {
    const CoverageSamples samples = sample_surface(wall(), kSpacing_mm, 1);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Vector3d& p = samples.position_mm[i];
        ASSERT_LT((position_mm(wall(), samples.at[i]) - p).norm(), 1e-12);
        const Eigen::Vector3d radial = Eigen::Vector3d(p.x(), p.y(), 0.0).normalized();
        ASSERT_GT(samples.normal[i].dot(radial), 0.999);
        ASSERT_LE(samples.at[i].bary.maxCoeff(), 1.0);
        ASSERT_GE(samples.at[i].bary.minCoeff(), 0.0);
    }
}

TEST(SampleSurface, LeavesNoHoles) {
    const CoverageSamples samples = sample_surface(wall(), kSpacing_mm, 1);
    test::Draw draw(3);
    int far = 0;
    constexpr int kProbes = 4000;
    for (int k = 0; k < kProbes; ++k) {
        const double angle = draw.between(0.0, 2.0 * kPi);
        const Eigen::Vector3d probe(20.0 * std::cos(angle), 20.0 * std::sin(angle),
                                    draw.between(-40.0, 40.0));
        double nearest = std::numeric_limits<double>::infinity();
        for (const Eigen::Vector3d& p : samples.position_mm) {
            nearest = std::min(nearest, (p - probe).norm());
        }
        far += nearest > kSpacing_mm ? 1 : 0;
        ASSERT_LT(nearest, 1.5 * kSpacing_mm);
    }
    EXPECT_LE(far, kProbes / 500);
}

TEST(SampleSurface, IsTheSameForASeedAndAnotherForAnother) {
    const CoverageSamples a = sample_surface(wall(), kSpacing_mm, 5);
    const CoverageSamples b = sample_surface(wall(), kSpacing_mm, 5);
    const CoverageSamples c = sample_surface(wall(), kSpacing_mm, 6);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a.position_mm[i], b.position_mm[i]);
    }
    EXPECT_NE(a.position_mm.front(), c.position_mm.front());
}

}  // namespace
}  // namespace meshwind
