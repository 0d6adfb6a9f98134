// Facets of closed-form shapes, whose vertices lie on them to the last bits.
#include "mesh/even/wall_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/even/shape_creases.h"
#include "mesh/even/slivers.h"
#include "mesh/even/winding_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/walls.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using test::Walls;
using test::walls_of;
using Kind = WallShape::Kind;

int count(const WallShapes& found, Kind kind) {
    return static_cast<int>(std::count_if(found.shapes.begin(), found.shapes.end(),
                                          [kind](const WallShape& s) { return s.kind == kind; }));
}

constexpr int kSegments = 48;

// A cylinder of 30 mm, a cone of 20 degrees, a cylinder of 20 mm: one row of facets each.
TriangleSoup reducer() {
    const double cone_mm = 10.0 / std::tan(rad_from_deg(20.0));
    return test::revolve(
        {{30.0, 0.0}, {30.0, 100.0}, {20.0, 100.0 + cone_mm}, {20.0, 200.0 + cone_mm}}, kSegments);
}

// A ball of 22 mm between two pipes of 20 mm, as at the node of a lug; the joints turn by 25
// degrees.
TriangleSoup node() {
    std::vector<Vector2d> profile{{20.0, -100.0}};
    const double end = std::acos(20.0 / 22.0);
    constexpr int kSteps = 6;
    for (int i = 0; i <= kSteps; ++i) {
        const double angle = end * (2.0 * i / kSteps - 1.0);
        profile.emplace_back(22.0 * std::cos(angle), 22.0 * std::sin(angle));
    }
    profile.emplace_back(20.0, 100.0);
    return test::revolve(profile, kSegments);
}

// A pipe of 20 mm into a round shoulder of 8 mm, in facets of 15 degrees.
TriangleSoup shoulder() {
    std::vector<Vector2d> profile{{20.0, 0.0}};
    for (int i = 0; i <= 6; ++i) {
        const double angle = rad_from_deg(15.0 * i);
        profile.emplace_back(12.0 + 8.0 * std::cos(angle), 100.0 + 8.0 * std::sin(angle));
    }
    return test::revolve(profile, kSegments);
}

// Two pipes and a short cone between them in two rows, whose rings have other numbers of vertices.
TriangleSoup step() {
    struct Ring {
        double radius_mm, z_mm;
        std::int32_t count;
    };
    TriangleSoup soup;
    std::int32_t before = -1;
    std::int32_t first = 0;
    for (const Ring& ring : {Ring{33.0, -100.0, 107}, Ring{33.0, 0.0, 107}, Ring{31.0, 2.1, 54},
                             Ring{29.0, 4.2, 107}, Ring{29.0, 100.0, 107}}) {
        const auto start = static_cast<std::int32_t>(soup.points_mm.size());
        for (std::int32_t i = 0; i < ring.count; ++i) {
            const double phi = 2.0 * kPi * i / ring.count;
            soup.points_mm.emplace_back(ring.radius_mm * std::cos(phi),
                                        ring.radius_mm * std::sin(phi), ring.z_mm);
        }
        for (std::int32_t i = 0, j = 0; before > 0 && (i < before || j < ring.count);) {
            const std::int32_t low = first + i % before;
            const std::int32_t high = start + j % ring.count;
            if (j == ring.count || (i < before && (i + 1) * ring.count <= (j + 1) * before)) {
                soup.faces.push_back({low, first + ++i % before, high});
            } else {
                soup.faces.push_back({low, start + ++j % ring.count, high});
            }
        }
        before = ring.count;
        first = start;
    }
    return soup;
}

TEST(WallShapes, OfAStepAreItsShortFacetsACone) {
    const Walls walls = walls_of(step());
    const WallShapes found = find_wall_shapes(walls.part, walls.kept);
    ASSERT_EQ(count(found, Kind::Ruled), 3);
    EXPECT_EQ(std::count(found.of_face.begin(), found.of_face.end(), -1), 0);
    EXPECT_TRUE(std::any_of(found.shapes.begin(), found.shapes.end(), [](const WallShape& shape) {
        return std::abs(std::abs(shape.ruled.growth) - 2.0 / 2.1) < 1e-9;
    }));
}

TEST(WallShapes, OfAReducerAreItsCylindersAndCone) {
    const Walls walls = walls_of(reducer());
    const WallShapes found = find_wall_shapes(walls.part, walls.kept);
    ASSERT_EQ(found.shapes.size(), 3U);
    EXPECT_EQ(count(found, Kind::Ruled), 3);
    EXPECT_EQ(std::count(found.of_face.begin(), found.of_face.end(), -1), 0);
    for (std::size_t f = 0; f < found.of_face.size(); ++f) {
        for (const std::int32_t v : walls.part.soup.faces[f]) {
            const WallShape& shape = found.shapes[static_cast<std::size_t>(found.of_face[f])];
            EXPECT_LT(shape.distance_mm(walls.part.soup.points_mm[static_cast<std::size_t>(v)]),
                      1e-9);
        }
    }
}

TEST(WallShapes, MeetInCreasesBelowTheFeatureAngle) {
    for (const TriangleSoup& soup : {reducer(), node()}) {
        Walls walls = walls_of(soup);
        const WallShapes found = find_wall_shapes(walls.part, walls.kept);
        EXPECT_EQ(mark_shape_creases(found, walls.kept, walls.part), 2 * kSegments);
    }
}

TEST(WallShapes, OfANodeHaveItsBall) {
    const Walls walls = walls_of(node());
    const WallShapes found = find_wall_shapes(walls.part, walls.kept);
    ASSERT_EQ(count(found, Kind::Ball), 1);
    for (const WallShape& shape : found.shapes) {
        if (shape.kind == Kind::Ball) {
            EXPECT_NEAR(shape.radius_mm, 22.0, 1e-9);
            EXPECT_LT(shape.centre_mm.norm(), 1e-9);
        }
    }
}

// Each ring of a round shoulder lies on a cone as well; only the pipe is one.
TEST(WallShapes, OfARoundShoulderAreNoCones) {
    Walls walls = walls_of(shoulder());
    const WallShapes found = find_wall_shapes(walls.part, walls.kept);
    ASSERT_EQ(found.shapes.size(), 1U);
    EXPECT_NEAR(found.shapes[0].ruled.radius_mm, 20.0, 1e-9);
    EXPECT_EQ(mark_shape_creases(found, walls.kept, walls.part), 0);
}

// Across a joint of 20 or 25 degrees curves would leave the vertices by up to 0.1 mm and more.
TEST(WindingMesh, KeepsSoftCreases) {
    for (const TriangleSoup& soup : {reducer(), node()}) {
        const Walls walls = walls_of(soup);
        const WindingMesh made = winding_mesh(walls.part, walls.kept);
        ASSERT_TRUE(made.report.own) << made.report.why_not;
        EXPECT_GT(least_quality(made.part, walls.kept), 0.4);
        EXPECT_LT(made.report.deviation_mm, 0.02);
    }
}

}  // namespace
}  // namespace meshwind
