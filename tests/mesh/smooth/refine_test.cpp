#include "mesh/smooth/refine.h"

#include <cstdio>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/exact_torus.h"
#include "tests/support/frozen.h"
#include "tests/support/mesh_measures.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

TriangleSoup soup_of(const Surface& surface) {
    return {surface.position_mm, surface.face};
}

double longest_edge_mm(const TriangleSoup& soup) {
    return test::measure(soup).max_edge_mm;
}

// Rms distance of the new vertices to the ideal surface.
double distance_mm(const char* kind, double edge_mm) {
    const Surface coarse =
        test::frozen(make_mandrel(kind, {}, {.edge_mm = edge_mm, .irregular = true}));
    const RefinedMesh fine = refined(coarse, 0.4 * edge_mm);
    double squares = 0.0;
    const std::size_t given = coarse.position_mm.size();
    for (std::size_t i = given; i < fine.soup.points_mm.size(); ++i) {
        const Vector3d& p = fine.soup.points_mm[i];
        squares += (mandrel_foot(kind, {}, p).point_mm - p).squaredNorm();
    }
    const double rms = std::sqrt(squares / static_cast<double>(fine.soup.points_mm.size() - given));
    std::printf("%s, edges of %.1f mm: new vertices %.3g mm off\n", kind, edge_mm, rms);
    return rms;
}

// Midpoints of flat edges are off by h^2 / 8R: order 2, 0.06 mm at h = 5 on a tube of 50 mm.
TEST(Refined, NewVerticesLieOnTheSurfaceToFourthOrder) {
    for (const char* kind : {"torus", "cylinder", "ellipsoid"}) {
        const double coarse = distance_mm(kind, 10.0);
        const double middle = distance_mm(kind, 5.0);
        const double fine = distance_mm(kind, 2.5);
        EXPECT_GT(0.5 * std::log2(coarse / fine), 4.0) << kind;
        EXPECT_LT(middle, 1e-2 * 5.0 * 5.0 / (8.0 * 50.0)) << kind;
    }
}

TEST(Refined, AreaConverges) {
    const Surface coarse = test::frozen(make_mandrel("torus", {}, {.edge_mm = 12.0}));
    const double exact_mm2 = 4.0 * kPi * kPi * 200.0 * 50.0;
    const double before = std::abs(area_mm2(soup_of(coarse)) - exact_mm2);
    // Facets fall short of the area by the square of their edges: a quarter of the edge, a
    // sixteenth of the error.
    const double after = std::abs(area_mm2(refined(coarse, 3.5).soup) - exact_mm2);
    EXPECT_LT(after, before / 12.0);
    EXPECT_LT(after, 2e-4 * exact_mm2);
}

std::size_t marked(const std::vector<std::array<std::uint8_t, 3>>& feature) {
    std::size_t count = 0;
    for (const auto& edges : feature) {
        count += static_cast<std::size_t>(edges[0] + edges[1] + edges[2]);
    }
    return count;
}

// Whatever the number of long edges in a triangle, the mesh stays whole and its parts what they
// are.
TEST(Refined, StaysManifoldWithTheSameRimsAndCreases) {
    for (const char* kind : {"tee", "combination", "vessel", "torus"}) {
        // The tee's blend of 15 mm must be shown without folds.
        const bool tee = kind == std::string("tee");
        const double given_edge_mm = tee ? 6.0 : 8.0;
        const Surface coarse =
            test::frozen(make_mandrel(kind, {}, {.edge_mm = given_edge_mm, .irregular = !tee}));
        const test::MeshMeasures given = test::measure(soup_of(coarse));
        for (const double share : {1.3, 0.9, 0.4}) {
            const double edge_mm = share * given_edge_mm;
            const RefinedMesh fine = refined(coarse, edge_mm);
            const test::MeshMeasures measures = test::measure(fine.soup);
            EXPECT_TRUE(measures.oriented_manifold) << kind << ' ' << edge_mm;
            EXPECT_EQ(measures.euler, given.euler);
            EXPECT_EQ(measures.rims, given.rims);
            EXPECT_LE(measures.max_edge_mm, edge_mm);
            EXPECT_GT(measures.min_angle_deg, 0.4 * given.min_angle_deg);
            ASSERT_EQ(fine.feature.size(), fine.soup.faces.size());
            ASSERT_EQ(fine.rim.size(), fine.soup.faces.size());
            const auto across = face_neighbours(fine.soup.faces);
            double crease_mm = 0.0;
            for (std::size_t f = 0; f < across.size(); ++f) {
                for (std::size_t e = 0; e < 3; ++e) {
                    ASSERT_EQ(fine.rim[f][e] >= 0, across[f][e] < 0);
                    if (fine.feature[f][e] != 0) {
                        crease_mm += (test::point_of(fine.soup, fine.soup.faces[f][e]) -
                                      test::point_of(fine.soup, fine.soup.faces[f][(e + 1) % 3]))
                                         .norm();
                    }
                }
            }
            double given_mm = 0.0;
            for (std::size_t f = 0; f < coarse.face.size(); ++f) {
                for (std::size_t e = 0; e < 3; ++e) {
                    if (coarse.feature[f][e] != 0) {
                        given_mm +=
                            (coarse.position_mm[static_cast<std::size_t>(coarse.face[f][e])] -
                             coarse.position_mm[static_cast<std::size_t>(
                                 coarse.face[f][(e + 1) % 3])])
                                .norm();
                    }
                }
            }
            // Chords of the same circles.
            EXPECT_GE(crease_mm, given_mm * (1.0 - 1e-9)) << kind;
            EXPECT_LE(crease_mm, given_mm * 1.02) << kind;
            EXPECT_GE(marked(fine.feature), marked(coarse.feature));
        }
    }
}

// The rim of the polar opening lies across the slanted wall: lifted along normals it would be
// scalloped by h^2 / 8R = 0.4 mm.
TEST(Refined, RimsStayCircles) {
    for (const char* kind : {"vessel", "cylinder"}) {
        const Surface coarse =
            test::frozen(make_mandrel(kind, {}, {.edge_mm = 8.0, .irregular = true}));
        const std::vector<Rim> given = find_rims(soup_of(coarse)).rims;
        const std::vector<Rim> fine = find_rims(refined(coarse, 1.5).soup).rims;
        ASSERT_EQ(fine.size(), given.size());
        for (std::size_t i = 0; i < fine.size(); ++i) {
            EXPECT_GT(fine[i].vertices.size(), 3 * given[i].vertices.size());
            EXPECT_NEAR(fine[i].radius_mm, given[i].radius_mm, 1e-3);
            EXPECT_LT(fine[i].circularity_mm, 1e-3);
            EXPECT_LT((fine[i].centre_mm - given[i].centre_mm).norm(), 1e-3);
        }
    }
}

TEST(Refined, KeepsRegionsAndGivenVertices) {
    TriangleSoup soup = make_mandrel("cylinder", {}, {.edge_mm = 10.0});
    Surface coarse = test::frozen(soup);
    for (std::size_t f = 0; f < coarse.region.size(); ++f) {
        coarse.region[f] = static_cast<std::int32_t>(f % 3);
    }
    std::array<double, 3> before{};
    std::array<double, 3> after{};
    const RefinedMesh fine = refined(coarse, 6.0);
    const auto add = [](const TriangleSoup& triangles, const std::vector<std::int32_t>& region,
                        std::array<double, 3>& areas) {
        for (std::size_t f = 0; f < triangles.faces.size(); ++f) {
            areas[static_cast<std::size_t>(region[f])] +=
                area_mm2({triangles.points_mm, {triangles.faces[f]}});
        }
    };
    add(soup, coarse.region, before);
    add(fine.soup, fine.region, after);
    for (std::size_t r = 0; r < 3; ++r) {
        EXPECT_NEAR(after[r], before[r], 0.01 * before[r]);
    }
    for (std::size_t i = 0; i < coarse.position_mm.size(); ++i) {
        ASSERT_EQ(fine.soup.points_mm[i], coarse.position_mm[i]);
    }
    EXPECT_EQ(fine.frozen().face.size(), fine.soup.faces.size());
    EXPECT_EQ(fine.frozen().region, fine.region);
}

TEST(Refined, LeavesAFineMeshAlone) {
    const Surface surface = test::frozen(make_mandrel("torus", {}, {.edge_mm = 10.0}));
    const RefinedMesh same = refined(surface, longest_edge_mm(soup_of(surface)));
    EXPECT_EQ(same.soup.faces, surface.face);
    EXPECT_EQ(same.soup.points_mm, surface.position_mm);
}

TEST(Refined, SameForAnyNumberOfThreads) {
    const Surface surface = test::frozen(make_mandrel("tee", {}, {.edge_mm = 12.0}));
    set_thread_count(1);
    const RefinedMesh one = refined(surface, 3.0);
    set_thread_count(2);
    const RefinedMesh two = refined(surface, 3.0);
    set_thread_count(0);
    EXPECT_EQ(one.soup.faces, two.soup.faces);
    EXPECT_EQ(one.soup.points_mm, two.soup.points_mm);
}

TEST(Refined, RefusesWhatCannotBeMade) {
    const Surface surface = test::frozen(make_mandrel("cylinder", {}, {.edge_mm = 20.0}));
    const auto code = [&](double edge_mm) -> std::string {
        try {
            (void)refined(surface, edge_mm);
        } catch (const InputError& error) {
            return error.code();
        }
        return "";
    };
    EXPECT_EQ(code(0.0), "refine.not_positive");
    EXPECT_EQ(code(-1.0), "refine.not_positive");
    EXPECT_EQ(code(std::nan("")), "refine.not_positive");
    EXPECT_EQ(code(INFINITY), "refine.not_positive");
    EXPECT_EQ(code(1e-3), "refine.too_many");
    EXPECT_EQ(code(1e-300), "refine.too_many");
}

}  // namespace
}  // namespace meshwind
