// What is a crease, and what only a few facets askew.
#include "mesh/segment/feature_edges.h"

#include <utility>

#include <gtest/gtest.h>

#include "mesh/edge_table.h"

namespace meshwind {
namespace {

// A plate of 40 mm with a needle in it that stands at 45 deg, as where three vertices are moved
// almost into one line. \param two a second one along it, tilted the other way
TriangleSoup plate_with_needles(bool two) {
    constexpr double kHigh = 0.02;
    TriangleSoup soup;
    soup.points_mm = {{-20.0, -20.0, 0.0}, {20.0, -20.0, 0.0},  {20.0, 20.0, 0.0},
                      {-20.0, 20.0, 0.0},  {-1.0, 0.0, 0.0},    {1.0, 0.0, 0.0},
                      {0.0, kHigh, kHigh}, {0.0, -kHigh, kHigh}};
    soup.faces = {{1, 2, 5}, {2, 6, 5}, {2, 3, 6}, {3, 4, 6}, {3, 0, 4}, {4, 5, 6}};
    if (two) {
        soup.faces.insert(soup.faces.end(), {{0, 7, 4}, {0, 1, 7}, {1, 5, 7}, {4, 7, 5}});
    } else {
        soup.faces.insert(soup.faces.end(), {{0, 1, 5}, {0, 5, 4}});
        soup.points_mm.pop_back();
    }
    return soup;
}

// A plate of 40 mm with a box of 1 mm on it.
TriangleSoup plate_with_box() {
    TriangleSoup soup;
    for (const auto& [half, z] : {std::pair(20.0, 0.0), std::pair(0.5, 0.0), std::pair(0.5, 1.0)}) {
        soup.points_mm.insert(
            soup.points_mm.end(),
            {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}});
    }
    for (std::int32_t below = 0; below < 8; below += 4) {
        for (std::int32_t i = below; i < below + 4; ++i) {
            const std::int32_t next = below + (i - below + 1) % 4;
            soup.faces.push_back({i, next, next + 4});
            soup.faces.push_back({i, next + 4, i + 4});
        }
    }
    soup.faces.insert(soup.faces.end(), {{8, 9, 10}, {8, 10, 11}});
    return soup;
}

// Sharp edges, each counted from both its faces.
int count(const TriangleSoup& soup) {
    const auto neighbours = face_neighbours(soup.faces);
    int sharp = 0;
    for (const auto& face : feature_edges(soup, steady_normals(soup, neighbours), neighbours)) {
        sharp += face[0] + face[1] + face[2];
    }
    return sharp;
}

TEST(FeatureEdges, DoNotBoundATriangleOrTwoThatStandAskew) {
    EXPECT_EQ(count(plate_with_needles(false)), 0);
    EXPECT_EQ(count(plate_with_needles(true)), 0);
}

TEST(FeatureEdges, BoundABoxAndWhatStandsOnAPlate) {
    TriangleSoup box = plate_with_box();
    EXPECT_EQ(count(box), 24);
    box.faces.erase(box.faces.begin(), box.faces.begin() + 8);  // the plate
    box.faces.insert(box.faces.end(), {{4, 6, 5}, {4, 7, 6}});
    EXPECT_EQ(count(box), 24);
}

}  // namespace
}  // namespace meshwind
