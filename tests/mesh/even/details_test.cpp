// Lettering is taken off a pipe, and the pipe itself goes on under it.
#include "mesh/even/enclosed_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 20.0;
constexpr int kSegments = 96;  // 1.3 mm each

// Lines across the pipe: long facets as CAD programs make them, but for where it has letters.
const std::vector<double> kLines_mm{0.0, 40.0, 42.0, 48.0, 50.0, 100.0};

using Height = std::function<double(int row, int segment)>;

// An open pipe about Z whose cells between lines and rulings stand out by a height each.
TriangleSoup pipe_with(const Height& height_mm) {
    TriangleSoup soup;
    const auto at = [](double up_mm, double z_mm, int segment) {
        const double angle = 2.0 * kPi * segment / kSegments;
        const double r = kRadius_mm + up_mm;
        return Vector3d(r * std::cos(angle), r * std::sin(angle), z_mm);
    };
    const auto quad = [&](const std::array<Vector3d, 4>& corner) {
        const auto first = static_cast<std::int32_t>(soup.points_mm.size());
        soup.points_mm.insert(soup.points_mm.end(), corner.begin(), corner.end());
        soup.faces.push_back({first, first + 1, first + 2});
        soup.faces.push_back({first, first + 2, first + 3});
    };
    const int rows = static_cast<int>(kLines_mm.size()) - 1;
    for (int row = 0; row < rows; ++row) {
        const double z0 = kLines_mm[static_cast<std::size_t>(row)];
        const double z1 = kLines_mm[static_cast<std::size_t>(row) + 1];
        for (int s = 0; s < kSegments; ++s) {
            const double up = height_mm(row, s);
            quad({at(up, z0, s), at(up, z0, s + 1), at(up, z1, s + 1), at(up, z1, s)});
            const double beside = height_mm(row, (s + 1) % kSegments);
            if (beside != up) {
                quad({at(beside, z0, s + 1), at(beside, z1, s + 1), at(up, z1, s + 1),
                      at(up, z0, s + 1)});
            }
            const double above = row + 1 < rows ? height_mm(row + 1, s) : up;
            if (above != up) {
                quad({at(above, z1, s), at(up, z1, s), at(up, z1, s + 1), at(above, z1, s + 1)});
            }
        }
    }
    return soup;
}

// An O of strokes of 2 and 2.6 mm and an I; `up_mm` < 0: cut in.
Height letters(double up_mm) {
    return [up_mm](int row, int s) {
        const bool o = row >= 1 && row <= 3 && s >= 10 && s < 16 && (row != 2 || s < 12 || s >= 14);
        const bool i = row >= 1 && row <= 3 && s >= 20 && s < 22;
        return o || i ? up_mm : 0.0;
    };
}

double farthest_off_mm(const Mandrel& mandrel) {
    double off = 0.0;
    for (const Vector3d& p : mandrel.surface.position_mm) {
        off = std::max(off, std::abs(p.head<2>().norm() - kRadius_mm));
    }
    return off;
}

TEST(Details, LettersAreTakenOffAPipe) {
    for (const double up_mm : {0.4, 0.8, -0.5}) {
        const Mandrel mandrel = build_mandrel(pipe_with(letters(up_mm)), "letters");
        EXPECT_EQ(mandrel.winding_mesh.details, 2) << up_mm;
        EXPECT_NEAR(mandrel.winding_mesh.details_mm, std::abs(up_mm), 0.01) << up_mm;
        EXPECT_TRUE(mandrel.winding_mesh.own) << mandrel.winding_mesh.why_not;
        EXPECT_LT(farthest_off_mm(mandrel), 1e-3) << up_mm;
        EXPECT_EQ(mandrel.rims.size(), 2U);
    }
}

TEST(Details, AreKeptWhereTheJobSaysSo) {
    const Mandrel mandrel =
        build_mandrel(pipe_with(letters(0.8)), "letters", {.remove_details_mm = 0.0});
    EXPECT_EQ(mandrel.winding_mesh.details, 0);
    EXPECT_NEAR(farthest_off_mm(mandrel), 0.8, 0.05);
}

TEST(Details, AreTakenOffUpToTheHeightThatTheJobSays) {
    EXPECT_EQ(build_mandrel(pipe_with(letters(2.0)), "high").winding_mesh.details, 0);
    const Mandrel mandrel =
        build_mandrel(pipe_with(letters(2.0)), "high", {.remove_details_mm = 2.5});
    EXPECT_EQ(mandrel.winding_mesh.details, 2);
    EXPECT_LT(farthest_off_mm(mandrel), 1e-3);
}

// A wall in more parts than lettering makes of it is rough, and looking at each from each would
// have no end.
TEST(Details, AreNotLookedForOnARoughWall) {
    constexpr int kAround = 48;
    const TriangleSoup wall = test::tube(kRadius_mm, 100.0, kAround, 20);
    std::vector<char> marked(wall.faces.size(), 0);
    for (std::size_t f = 2 * kAround; f + 2 * kAround < marked.size(); f += 7) {
        marked[f] = 1;  // in 18 of 20 rows, none beside another
    }
    EXPECT_GT(enclosed_places(wall, marked, 0.05, 1000).size(), 200U);
    EXPECT_TRUE(enclosed_places(wall, marked, 0.05, 200).empty());
}

// A collar goes around its leg, and a key along the pipe reaches both its ends.
TEST(Details, AreNoCollarsAndKeys) {
    const Height collar = [](int row, int) { return row == 2 ? 0.8 : 0.0; };
    EXPECT_EQ(build_mandrel(pipe_with(collar), "collar").winding_mesh.details, 0);
    const Height key = [](int, int s) { return s == 4 || s == 5 ? 0.8 : 0.0; };
    EXPECT_EQ(build_mandrel(pipe_with(key), "key").winding_mesh.details, 0);
}

}  // namespace
}  // namespace meshwind
