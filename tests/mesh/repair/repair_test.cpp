#include "mesh/repair/repair.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/error.h"
#include "mesh/edge_table.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

double volume(const TriangleSoup& soup) {
    double sum = 0.0;
    for (const auto& [a, b, c] : soup.faces) {
        sum += soup.points_mm[static_cast<std::size_t>(a)].dot(
                   soup.points_mm[static_cast<std::size_t>(b)].cross(
                       soup.points_mm[static_cast<std::size_t>(c)])) /
               6.0;
    }
    return sum;
}

int open_edges(const TriangleSoup& soup) {
    int open = 0;
    for (const auto& face : face_neighbours(soup.faces)) {
        open += static_cast<int>(std::count(face.begin(), face.end(), -1));
    }
    return open;
}

RepairReport repaired(TriangleSoup& soup) {
    RepairReport report;
    repair(soup, "test", report);
    return report;
}

std::string code_of(TriangleSoup soup) {
    try {
        (void)repaired(soup);
    } catch (const InputError& error) {
        return error.code();
    }
    return "none";
}

TEST(Repair, LeavesASoundSolidAlone) {
    TriangleSoup soup = test::box({0, 0, 0}, {10, 20, 30});
    const RepairReport report = repaired(soup);
    EXPECT_EQ(soup.faces.size(), 12U);
    EXPECT_EQ(soup.points_mm.size(), 8U);
    EXPECT_NEAR(volume(soup), 6000.0, 1e-9);
    EXPECT_EQ(open_edges(soup), 0);
    EXPECT_EQ(report.faces_flipped, 0);
    EXPECT_EQ(report.components, 1);
    EXPECT_EQ(report.self_intersecting_faces, 0);
}

TEST(Repair, DropsDuplicatesWhateverTheirTurn) {
    TriangleSoup soup = test::box({0, 0, 0}, {10, 10, 10});
    soup.faces.push_back(soup.faces[3]);
    soup.faces.push_back({soup.faces[5][2], soup.faces[5][1], soup.faces[5][0]});
    EXPECT_EQ(repaired(soup).duplicate_faces_removed, 2);
    EXPECT_EQ(soup.faces.size(), 12U);
}

TEST(Repair, TurnsFlippedFacesBack) {
    TriangleSoup soup = test::box({0, 0, 0}, {10, 10, 10});
    std::swap(soup.faces[2][0], soup.faces[2][1]);
    std::swap(soup.faces[7][0], soup.faces[7][1]);
    EXPECT_EQ(repaired(soup).faces_flipped, 2);
    EXPECT_NEAR(volume(soup), 1000.0, 1e-9);
}

TEST(Repair, TurnsAnInvertedSolidOutward) {
    TriangleSoup soup = test::box({0, 0, 0}, {10, 10, 10});
    for (auto& face : soup.faces) {
        std::swap(face[0], face[1]);
    }
    EXPECT_EQ(repaired(soup).faces_flipped, 12);
    EXPECT_NEAR(volume(soup), 1000.0, 1e-9);
}

TEST(Repair, TurnsAnOpenTubeToTheSideThatIsSeen) {
    TriangleSoup soup = test::tube(10.0, 60.0, 24);
    for (auto& face : soup.faces) {
        std::swap(face[0], face[1]);
    }
    (void)repaired(soup);
    for (const auto& [a, b, c] : soup.faces) {
        const Eigen::Vector3d& p = soup.points_mm[static_cast<std::size_t>(a)];
        const Eigen::Vector3d normal = (soup.points_mm[static_cast<std::size_t>(b)] - p)
                                           .cross(soup.points_mm[static_cast<std::size_t>(c)] - p);
        EXPECT_GT(normal.dot(Eigen::Vector3d(p.x(), p.y(), 0.0)), 0.0);
    }
}

TEST(Repair, RemovesACapWithoutOpeningTheSolid) {
    // The middle of an edge of the box is a vertex on one side only: the other side has a cap
    // there.
    TriangleSoup soup = test::box({0, 0, 0}, {10, 10, 10});
    soup.points_mm.emplace_back(5.0, 5.0, 0.0);  // on the diagonal 1-2 of the bottom
    soup.faces[0] = {0, 2, 8};
    soup.faces.push_back({0, 8, 1});
    soup.faces.push_back({1, 8, 2});  // no area
    EXPECT_EQ(repaired(soup).degenerate_faces_removed, 1);
    EXPECT_EQ(open_edges(soup), 0);
    EXPECT_NEAR(volume(soup), 1000.0, 1e-9);
}

TEST(Repair, RemovesANeedleWithoutOpeningTheSolid) {
    TriangleSoup soup = test::tube(10.0, 40.0, 12);
    soup.points_mm.push_back(soup.points_mm[20] + Eigen::Vector3d(0, 0, 1e-14));
    for (std::size_t f = 0, turned = 0; f < soup.faces.size() && turned < 1; ++f) {
        auto& face = soup.faces[f];
        const auto at = std::find(face.begin(), face.end(), 20);
        if (at != face.end()) {  // this face takes the copy; two needles fill the gap
            const auto i = static_cast<std::size_t>(at - face.begin());
            const std::int32_t next = face[(i + 1) % 3];
            const std::int32_t before = face[(i + 2) % 3];
            const auto copy = static_cast<std::int32_t>(soup.points_mm.size() - 1);
            *at = copy;
            soup.faces.push_back({20, next, copy});
            soup.faces.push_back({20, copy, before});
            ++turned;
        }
    }
    EXPECT_EQ(repaired(soup).degenerate_faces_removed, 2);
    EXPECT_EQ(open_edges(soup), 24);
}

TEST(Repair, PartsTwoSolidsThatShareAnEdge) {
    TriangleSoup soup = test::box({0, 0, 0}, {10, 10, 10});
    // The second box shares the edge from (10, 10, 0) to (10, 10, 10): vertices 3 and 7.
    const TriangleSoup other = test::box({10, 10, 0}, {20, 20, 10});
    std::array<std::int32_t, 8> at{};
    for (std::size_t v = 0; v < 8; ++v) {
        at[v] = v == 0 ? 3 : v == 4 ? 7 : static_cast<std::int32_t>(soup.points_mm.size());
        if (v != 0 && v != 4) {
            soup.points_mm.push_back(other.points_mm[v]);
        }
    }
    for (const auto& [a, b, c] : other.faces) {
        soup.faces.push_back({at[static_cast<std::size_t>(a)], at[static_cast<std::size_t>(b)],
                              at[static_cast<std::size_t>(c)]});
    }
    const RepairReport report = repaired(soup);
    EXPECT_EQ(report.non_manifold_vertices_split, 2);
    EXPECT_EQ(report.components, 2);
    EXPECT_EQ(open_edges(soup), 0);
    EXPECT_NEAR(volume(soup), 2000.0, 1e-9);
}

// Cells of a grid, two full layers and between them two that touch along one edge: both ends of
// that edge have a single fan, so splitting vertices alone cannot part the four faces at it.
TEST(Repair, PartsSheetsThatTouchAlongAnInnerEdge) {
    const auto full = [](int x, int y, int z) {
        return x >= 0 && x < 2 && y >= 0 && y < 2 && z >= 0 && z < 3 && (z != 1 || x == y);
    };
    TriangleSoup soup;
    for (int i = 0; i < 36; ++i) {
        soup.points_mm.emplace_back(10.0 * (i % 3), 10.0 * (i / 3 % 3), 10.0 * (i / 9));
    }
    const auto vertex = [](const Eigen::Vector3i& p) { return p.x() + 3 * p.y() + 9 * p.z(); };
    for (int cell = 0; cell < 12; ++cell) {
        const Eigen::Vector3i low(cell % 2, cell / 2 % 2, cell / 4);
        for (int side = 0; side < 6 && full(low.x(), low.y(), low.z()); ++side) {
            const Eigen::Vector3i u = Eigen::Vector3i::Unit((side + 1) % 3);
            const Eigen::Vector3i v = Eigen::Vector3i::Unit((side + 2) % 3);
            const Eigen::Vector3i out = Eigen::Vector3i::Unit(side % 3) * (side < 3 ? 1 : -1);
            const Eigen::Vector3i next = low + out;
            if (full(next.x(), next.y(), next.z())) {
                continue;
            }
            const Eigen::Vector3i p = side < 3 ? next : low;
            const Eigen::Vector3i q = side < 3 ? p + u : p + v;
            const Eigen::Vector3i r = side < 3 ? p + v : p + u;
            soup.faces.push_back({vertex(p), vertex(q), vertex(r)});
            soup.faces.push_back({vertex(q), vertex(p + u + v), vertex(r)});
        }
    }
    EXPECT_EQ(repaired(soup).components, 1);
    EXPECT_EQ(open_edges(soup), 0);
    EXPECT_NEAR(volume(soup), 10000.0, 1e-9);
}

TEST(Repair, CutsAnEdgeWhereThreeSheetsMeet) {
    TriangleSoup soup;
    soup.points_mm = {{0, 0, 0}, {0, 0, 10}, {10, 0, 5}, {-10, 0, 5}, {0, 10, 5}};
    soup.faces = {{0, 2, 1}, {0, 1, 3}, {0, 1, 4}};
    const RepairReport report = repaired(soup);
    EXPECT_EQ(report.components, 3);
    EXPECT_EQ(report.non_manifold_vertices_split, 4);
    EXPECT_EQ(soup.faces.size(), 3U);
}

TEST(Repair, CountsCrossingFaces) {
    TriangleSoup soup = test::box({0, 0, 0}, {10, 10, 10});
    test::add(soup, test::box({5, 5, 5}, {15, 15, 15}));
    EXPECT_GT(repaired(soup).self_intersecting_faces, 0);
}

TEST(Repair, RefusesAMoebiusBand) {
    constexpr int kSteps = 24;
    TriangleSoup soup;
    for (int i = 0; i < kSteps; ++i) {
        const double turn = 2.0 * kPi * i / kSteps;
        for (const double side : {-5.0, 5.0}) {
            const double r = 30.0 + side * std::cos(turn / 2.0);
            soup.points_mm.emplace_back(r * std::cos(turn), r * std::sin(turn),
                                        side * std::sin(turn / 2.0));
        }
    }
    for (std::int32_t i = 0; i < kSteps; ++i) {
        const bool last = i + 1 == kSteps;
        const std::int32_t a = 2 * i;
        const std::int32_t b = last ? 1 : a + 2;
        const std::int32_t d = last ? 0 : a + 3;
        soup.faces.push_back({a, b, a + 1});
        soup.faces.push_back({b, d, a + 1});
    }
    EXPECT_EQ(code_of(soup), "mesh.not_orientable");
}

TEST(Repair, RefusesASurfaceWithoutArea) {
    TriangleSoup soup;
    soup.points_mm = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    soup.faces = {{0, 1, 2}, {0, 0, 1}};
    EXPECT_EQ(code_of(soup), "mesh.no_triangles_left");
}

}  // namespace
}  // namespace meshwind
