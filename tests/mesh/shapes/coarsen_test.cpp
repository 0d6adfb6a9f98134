#include "mesh/shapes/coarsen.h"

#include <set>

#include <gtest/gtest.h>

#include "mesh/shapes/make_kinds.h"
#include "tests/support/frozen.h"

namespace meshwind {
namespace {

double mean_edge_mm(const TriangleSoup& soup) {
    return test::frozen(soup).mean_edge_mm;
}

TEST(Coarsened, KeepsPointsRimsAndAreaOfATee) {
    const TriangleSoup fine = make_mandrel("tee", {}, {.edge_mm = 6.0});
    std::set<std::array<double, 3>> given;
    for (const Eigen::Vector3d& p : fine.points_mm) {
        given.insert({p.x(), p.y(), p.z()});
    }
    for (const double edge_mm : {10.0, 16.0}) {
        const TriangleSoup coarse = coarsened(fine, edge_mm);
        for (const Eigen::Vector3d& p : coarse.points_mm) {
            ASSERT_EQ(given.count({p.x(), p.y(), p.z()}), 1U);
        }
        EXPECT_EQ(find_rims(coarse).rims.size(), 3U);
        // Triangles shrink as chords do: (16 / 40)^2 / 8 of the area at most.
        EXPECT_NEAR(area_mm2(coarse), area_mm2(fine), 0.02 * area_mm2(fine));
        EXPECT_NEAR(mean_edge_mm(coarse), edge_mm, 0.15 * edge_mm);
        // Hardly an edge looks like a crease: on the blend's ball of 15 mm facets turn fastest.
        const Surface surface = test::frozen(coarse);
        std::size_t creases = 0;
        for (const auto& feature : surface.feature) {
            creases += static_cast<std::size_t>(feature[0] + feature[1] + feature[2]);
        }
        EXPECT_LT(creases, 3 * surface.face.size() / 100);
    }
}

// The sharp rings between cylinder, cone and cylinder: no facet reaches across one.
TEST(Coarsened, KeepsCreases) {
    const TriangleSoup fine =
        make_mandrel("combination", {{"cone-length", 15.0}}, {.edge_mm = 5.0});
    const TriangleSoup coarse = coarsened(fine, 12.0);
    EXPECT_LT(coarse.faces.size(), fine.faces.size() / 2);
    for (const double ring_mm : {120.0, 135.0}) {
        for (const auto& face : coarse.faces) {
            bool below = false;
            bool above = false;
            for (const std::int32_t v : face) {
                const double z = coarse.points_mm[static_cast<std::size_t>(v)].z();
                below = below || z < ring_mm - 1e-9;
                above = above || z > ring_mm + 1e-9;
            }
            ASSERT_FALSE(below && above);
        }
    }
}

TEST(Coarsened, LeavesACoarserMeshAlone) {
    const TriangleSoup soup = make_mandrel("cylinder", {}, {.edge_mm = 20.0});
    EXPECT_EQ(coarsened(soup, 5.0).faces, soup.faces);
}

}  // namespace
}  // namespace meshwind
