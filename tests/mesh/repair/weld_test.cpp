#include "mesh/repair/weld.h"

#include <gtest/gtest.h>

#include "mesh/edge_table.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

TriangleSoup exploded(const TriangleSoup& soup) {
    TriangleSoup loose;
    for (const auto& face : soup.faces) {
        const auto first = static_cast<std::int32_t>(loose.points_mm.size());
        for (const std::int32_t v : face) {
            loose.points_mm.push_back(soup.points_mm[static_cast<std::size_t>(v)]);
        }
        loose.faces.push_back({first, first + 1, first + 2});
    }
    return loose;
}

int open_edges(const TriangleSoup& soup) {
    int open = 0;
    for (const auto& face : face_neighbours(soup.faces)) {
        open += static_cast<int>(std::count(face.begin(), face.end(), -1));
    }
    return open;
}

TEST(Weld, JoinsEqualPointsAndSignedZeros) {
    TriangleSoup soup = exploded(test::box({0, 0, 0}, {10, 20, 30}));
    soup.points_mm[0] = {-0.0, 0.0, -0.0};
    EXPECT_EQ(weld(soup).welded_points, 36 - 8);
    EXPECT_EQ(soup.points_mm.size(), 8U);
    EXPECT_EQ(open_edges(soup), 0);
}

TEST(Weld, ClosesBordersThatDifferByRounding) {
    TriangleSoup soup = exploded(test::tube(10.0, 40.0, 24));
    for (std::size_t v = 0; v < soup.points_mm.size(); v += 2) {
        soup.points_mm[v] += Eigen::Vector3d(1e-6, -1e-6, 1e-6);  // 4e-8 of the diagonal
    }
    const WeldReport report = weld(soup);
    EXPECT_EQ(soup.points_mm.size(), 24U * 5U);
    EXPECT_EQ(open_edges(soup), 2 * 24);
    EXPECT_GT(report.edges_stitched, 0);
}

// A strip of triangles lower than the border tolerance, with open edges on both long sides.
TEST(Weld, KeepsSliversOnBorders) {
    TriangleSoup soup = test::tube(10.0, 40.0, 24);
    const double low = 0.5 * kBorderWeldShare * diagonal_mm(soup);
    const auto first = static_cast<std::int32_t>(soup.points_mm.size());
    soup.points_mm.emplace_back(100.0, 0.0, 0.0);
    soup.points_mm.emplace_back(105.0, 0.0, 0.0);
    soup.points_mm.emplace_back(105.0, low, 0.0);
    soup.faces.push_back({first, first + 1, first + 2});
    const std::size_t before = soup.faces.size();
    weld(soup);
    EXPECT_EQ(soup.faces.size(), before);
    for (const auto& [a, b, c] : soup.faces) {
        EXPECT_TRUE(a != b && b != c && c != a);
    }
}

TEST(Weld, LeavesNearPointsInsideTheSurfaceAlone) {
    TriangleSoup soup = test::box({0, 0, 0}, {10, 10, 1e-6});
    weld(soup);
    EXPECT_EQ(soup.points_mm.size(), 8U);
}

}  // namespace
}  // namespace meshwind
