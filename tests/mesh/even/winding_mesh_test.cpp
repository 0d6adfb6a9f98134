#include "mesh/even/winding_mesh.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "core/units.h"
#include "mesh/even/even_mesh.h"
#include "mesh/even/long_facets.h"
#include "mesh/even/slivers.h"
#include "mesh/even/wall_surface.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/revolution/revolution.h"
#include "mesh/shapes/make_kinds.h"
#include "mesh/tube/tube.h"
#include "tests/support/uneven.h"
#include "tests/support/walls.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using test::Walls;
using test::walls_of;

double longest_wall_edge(const LabelledMesh& part, const std::vector<char>& kept) {
    double longest = 0.0;
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        if (kept[static_cast<std::size_t>(part.region[f])] == 0) {
            continue;
        }
        for (std::size_t e = 0; e < 3; ++e) {
            const auto a = static_cast<std::size_t>(part.soup.faces[f][e]);
            const auto b = static_cast<std::size_t>(part.soup.faces[f][(e + 1) % 3]);
            longest = std::max(longest, (part.soup.points_mm[a] - part.soup.points_mm[b]).norm());
        }
    }
    return longest;
}

// New vertices lie on the cylinder itself, not on its facets, which are 0.38 mm inside.
TEST(LongFacets, AreHalvedOnTheirCylinder) {
    const Walls walls = walls_of(test::one_row_cylinder(50.0, 400.0, 36));
    const LongFacets halved = halve_long_facets(walls.part, walls.kept, 6.0);
    EXPECT_EQ(halved.shapes, 1);
    EXPECT_LT(halved.residual_mm, 1e-9);
    EXPECT_GT(halved.part.soup.points_mm.size(), 2000U);
    for (const Vector3d& p : halved.part.soup.points_mm) {
        if (std::abs(p.z()) < 199.0) {
            EXPECT_NEAR(p.head<2>().norm(), 50.0, 1e-9);
        }
    }
    EXPECT_LT(longest_wall_edge(halved.part, walls.kept), 8.8);  // chords of the rims: 8.72
}

// A wall of quality 0.04 becomes one above 0.5, on the cylinder to fourth order in its edges.
TEST(WindingMesh, OfOneRowOfFacetsIsEven) {
    const Walls walls = walls_of(test::one_row_cylinder(50.0, 400.0, 36));
    const WindingMesh made = winding_mesh(walls.part, walls.kept);
    ASSERT_TRUE(made.report.own);
    EXPECT_LT(made.report.least_quality, 0.1);
    EXPECT_GT(least_quality(made.part, walls.kept), 0.5);
    double off = 0.0;
    for (const Vector3d& p : made.part.soup.points_mm) {
        off = std::max(off, std::abs(p.z()) < 199.999 ? std::abs(p.head<2>().norm() - 50.0) : 0.0);
    }
    // Facets of 10 degrees are up to 0.19 mm inside: two hundred times as far.
    EXPECT_LT(off, 1e-3);
    EXPECT_LT(made.report.deviation_mm, 1e-3);
}

// Even meshes are wound as they came: not a bit is changed.
TEST(WindingMesh, OfAnEvenMeshIsTheFiles) {
    for (const char* kind : {"tee", "elbow", "vessel", "cone"}) {
        const Walls walls = walls_of(make_mandrel(kind, {}, {.edge_mm = 8.0}));
        const WindingMesh made = winding_mesh(walls.part, walls.kept);
        EXPECT_FALSE(made.report.own) << kind;
        EXPECT_EQ(made.part.soup.points_mm, walls.part.soup.points_mm) << kind;
        EXPECT_EQ(made.part.soup.faces, walls.part.soup.faces) << kind;
    }
}

double off_mm(const char* kind, const LabelledMesh& part, const std::vector<char>& kept) {
    double off = 0.0;
    for (std::size_t f = 0; f < part.soup.faces.size(); ++f) {
        if (kept[static_cast<std::size_t>(part.region[f])] != 0) {
            for (const std::int32_t v : part.soup.faces[f]) {
                const Vector3d& p = part.soup.points_mm[static_cast<std::size_t>(v)];
                off = std::max(off, (mandrel_foot(kind, {}, p).point_mm - p).norm());
            }
        }
    }
    return off;
}

// All needles in a good mesh go; what is left is as near to the exact surface as what the good mesh
// itself gives.
TEST(WindingMesh, OfAMeshWithNeedlesHasNone) {
    for (const char* kind : {"tee", "elbow", "vessel"}) {
        const TriangleSoup soup = make_mandrel(kind, {}, {.edge_mm = 5.0});
        const Walls good = walls_of(soup);
        const double size_mm = std::sqrt(area_mm2(soup) / (4.0 * kPi));
        const LabelledMesh even =
            even_mesh(good.part, good.kept, frozen_wall(good.part, good.kept),
                      {.least_mm = 0.02 * size_mm, .longest_mm = 0.15 * size_mm});
        const Walls walls = walls_of(test::with_needles(soup, 40, 1e-3, 7));
        const WindingMesh made = winding_mesh(walls.part, walls.kept);
        ASSERT_TRUE(made.report.own) << kind;
        EXPECT_GT(least_quality(made.part, walls.kept), 0.4) << kind;
        EXPECT_LT(off_mm(kind, made.part, walls.kept), 1.5 * off_mm(kind, even, good.kept) + 0.002)
            << kind;
    }
}

// One part, many meshes: rims, axis and recognition are those of the even mesh.
TEST(WindingMesh, LeavesRimsAndKindOfThePart) {
    const TriangleSoup soup = make_mandrel("elbow", {}, {.edge_mm = 4.0});
    const Mandrel even = build_mandrel(soup, "even", {.mesh = MandrelOptions::Mesh::Even});
    const Mandrel uneven = build_mandrel(test::with_needles(soup, 60, 1e-3, 3), "uneven",
                                         {.mesh = MandrelOptions::Mesh::Even});
    EXPECT_FALSE(even.winding_mesh.own);
    ASSERT_TRUE(uneven.winding_mesh.own);
    ASSERT_EQ(uneven.rims.size(), even.rims.size());
    for (std::size_t i = 0; i < even.rims.size(); ++i) {
        EXPECT_NEAR(uneven.rims[i].radius_mm, even.rims[i].radius_mm, 1e-3);
        EXPECT_LT(uneven.rims[i].circularity_mm, 2e-3);
    }
    const TubeFinding one = find_tube(even);
    const TubeFinding other = find_tube(uneven);
    ASSERT_TRUE(one.tube);
    ASSERT_TRUE(other.tube) << other.why_not;
    ASSERT_EQ(other.tube->parts.size(), one.tube->parts.size());
    for (std::size_t i = 0; i < one.tube->parts.size(); ++i) {
        EXPECT_NEAR(other.tube->parts[i].bend_radius_mm, one.tube->parts[i].bend_radius_mm, 0.05);
    }
}

TEST(WindingMesh, IsTheSameForAnyNumberOfThreads) {
    const Walls walls = walls_of(test::one_row_cylinder(20.0, 100.0, 24));
    set_thread_count(1);
    const WindingMesh one = winding_mesh(walls.part, walls.kept);
    set_thread_count(3);
    const WindingMesh three = winding_mesh(walls.part, walls.kept);
    set_thread_count(0);
    EXPECT_EQ(one.part.soup.points_mm, three.part.soup.points_mm);
    EXPECT_EQ(one.part.soup.faces, three.part.soup.faces);
}

}  // namespace
}  // namespace meshwind
