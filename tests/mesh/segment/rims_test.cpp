#include "mesh/segment/rims.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace meshwind {
namespace {

TEST(FindRims, TubeHasTwoExactCircles) {
    const Rims rims = find_rims(test::tube(10.0, 40.0, 24));
    ASSERT_EQ(rims.rims.size(), 2U);
    for (const Rim& rim : rims.rims) {
        const double end = rim.axis.z() > 0.0 ? 40.0 : 0.0;
        EXPECT_NEAR((rim.centre_mm - Eigen::Vector3d(0, 0, end)).norm(), 0.0, 1e-12);
        EXPECT_NEAR(std::abs(rim.axis.z()), 1.0, 1e-12);
        EXPECT_NEAR(rim.radius_mm, 10.0, 1e-12);
        EXPECT_NEAR(rim.circularity_mm, 0.0, 1e-12);
        EXPECT_EQ(rim.vertices.size(), 24U);
    }
    EXPECT_LT(rims.rims[0].axis.dot(rims.rims[1].axis), 0.0);
}

TEST(FindRims, LoopsTurnCounterClockwiseAboutTheirAxis) {
    const TriangleSoup soup = test::tube(10.0, 40.0, 24);
    for (const Rim& rim : find_rims(soup).rims) {
        const auto arm = [&](std::size_t i) {
            return Eigen::Vector3d(soup.points_mm[static_cast<std::size_t>(rim.vertices[i])] -
                                   rim.centre_mm);
        };
        EXPECT_GT(arm(0).cross(arm(1)).dot(rim.axis), 0.0);
    }
}

TEST(FindRims, UnevenSpacingDoesNotPullTheCircle) {
    // Half of the circle has 4 points, the other half 96.
    TriangleSoup soup;
    std::vector<double> angles;
    for (int i = 0; i < 4; ++i) {
        angles.push_back(kPi * i / 4);
    }
    for (int i = 0; i < 96; ++i) {
        angles.push_back(kPi + kPi * i / 96);
    }
    const auto n = static_cast<std::int32_t>(angles.size());
    for (const double z : {0.0, 20.0}) {
        for (const double angle : angles) {
            soup.points_mm.emplace_back(3.0 + 7.0 * std::cos(angle), 7.0 * std::sin(angle), z);
        }
    }
    for (std::int32_t i = 0; i < n; ++i) {
        const std::int32_t j = (i + 1) % n;
        soup.faces.push_back({i, j, n + i});
        soup.faces.push_back({j, n + j, n + i});
    }
    for (const Rim& rim : find_rims(soup).rims) {
        EXPECT_NEAR(rim.centre_mm.x(), 3.0, 1e-12);
        EXPECT_NEAR(rim.radius_mm, 7.0, 1e-12);
    }
}

TEST(FindRims, SmallHolesInTheWallAreNotRims) {
    TriangleSoup soup = test::tube(10.0, 40.0, 96, 40);
    soup.faces.erase(soup.faces.begin() + 2000);
    const Rims rims = find_rims(soup);
    EXPECT_EQ(rims.rims.size(), 2U);
    EXPECT_EQ(rims.holes_mm.size(), 1U);
}

// Each row of facets is as long as the pipe is wide: the corners of the window lie on a circle.
TEST(FindRims, WindowOfAFacetOrTwoIsNoCircle) {
    TriangleSoup soup = test::tube(10.0, 60.0, 12, 3);
    std::erase_if(soup.faces, [&](const auto& face) {
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const std::int32_t v : face) {
            middle += soup.points_mm[static_cast<std::size_t>(v)] / 3.0;
        }
        return middle.z() > 20.0 && middle.z() < 40.0 && std::abs(middle.y()) < 4.0 &&
               middle.x() > 0.0;
    });
    const Rims rims = find_rims(soup);
    ASSERT_EQ(rims.rims.size(), 3U);
    for (const Rim& rim : rims.rims) {
        const bool is_end = std::abs(rim.axis.z()) > 0.9;
        EXPECT_EQ(rim.circularity_mm < 1e-9, is_end);
        EXPECT_EQ(rim.circularity_mm < 0.3 * rim.radius_mm, is_end);
    }
}

TEST(FindRims, EndOfSixFacetsIsACircle) {
    const Rims rims = find_rims(test::tube(10.0, 40.0, 6, 1));
    ASSERT_EQ(rims.rims.size(), 2U);
    EXPECT_LT(rims.rims[0].circularity_mm, 1e-9);
}

}  // namespace
}  // namespace meshwind
