// Paths between two points against independent solutions and the polyhedron's own distance.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>
#include <GeographicLib/GeodesicExact.hpp>

#include "geodesic/connect.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/reference.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kSeed = 5;

Surface made(const char* kind, const MakeValues& values, double edge_mm) {
    return test::frozen(make_mandrel(kind, values, {.edge_mm = edge_mm, .irregular = true}));
}

void expect_reached(const Surface& surface, const ConnectResult& result, const SurfacePoint& from,
                    const SurfacePoint& to) {
    ASSERT_EQ(result.stop, ConnectStop::Reached) << name_of(result.stop) << ", " << result.miss_mm;
    EXPECT_LE(result.miss_mm, 1e-6);
    EXPECT_LT((result.path.front().position_mm - position_mm(surface, from)).norm(), 1e-12);
    // The facet leans from the tangent plane by up to h / (2 r), 0.27 on the tee's blend.
    EXPECT_LT((result.path.back().position_mm - position_mm(surface, to)).norm(), 1.1e-6);
}

struct Spheroid {
    double equator_radius_mm;
    double pole_radius_mm;
};

// Root mean square of the length's error against GeographicLib's inverse problem.
double spheroid_error_mm(const Spheroid& shape, double edge_mm) {
    const MakeValues values{{"equator-radius", shape.equator_radius_mm},
                            {"pole-radius", shape.pole_radius_mm}};
    const Surface surface = made("ellipsoid", values, edge_mm);
    const GeographicLib::GeodesicExact solver(shape.equator_radius_mm,
                                              1.0 - shape.pole_radius_mm / shape.equator_radius_mm);
    std::mt19937_64 random(kSeed);
    double squares = 0.0;
    int pairs = 0;
    for (int source = 0; source < 3; ++source) {
        const SurfacePoint from = test::random_start(surface, random).at;
        ShortestPaths tree(surface, from);
        for (int target = 0; target < 10; ++target, ++pairs) {
            const SurfacePoint to = test::random_start(surface, random).at;
            const ConnectResult result = connect(surface, from, to, tree.to(to).value());
            expect_reached(surface, result, from, to);
            const auto place = [&](const SurfacePoint& at) {
                const Vector3d n =
                    mandrel_foot("ellipsoid", values, position_mm(surface, at)).normal;
                return std::pair{deg_from_rad(std::asin(n.z())),
                                 deg_from_rad(std::atan2(n.y(), n.x()))};
            };
            const auto [lat1, lon1] = place(from);
            const auto [lat2, lon2] = place(to);
            double exact = 0.0;
            solver.Inverse(lat1, lon1, lat2, lon2, exact);
            squares += (result.length_mm - exact) * (result.length_mm - exact);
        }
    }
    const double rms = std::sqrt(squares / pairs);
    std::printf("spheroid %.0f x %.0f, h %4.1f mm: rms length error %.4f mm\n",
                shape.equator_radius_mm, shape.pole_radius_mm, edge_mm, rms);
    return rms;
}

// The facets' way is short by about h^2 / (24 r^2) of itself and its ends lie inside: some
// h^2 / (6 r) at h = 10, second order.
TEST(ConnectOrder, SpheroidLengthsAgreeWithGeographicLib) {
    for (const Spheroid& shape : {Spheroid{100.0, 75.0}, Spheroid{75.0, 100.0}}) {
        const double coarse = spheroid_error_mm(shape, 10.0);
        const double fine = spheroid_error_mm(shape, 5.0);
        EXPECT_LT(coarse, 0.6);
        EXPECT_LT(fine, 0.15);
        EXPECT_GT(coarse / fine, std::exp2(1.7));
    }
}

// Mean of what the path is longer than the shortest way over the facets, 20 targets up to 300 mm
// away: farther ones on a torus are seen over more than one way.
double torus_excess_mm(double edge_mm) {
    const Surface surface = made("torus", {}, edge_mm);
    std::mt19937_64 random(kSeed);
    const SurfacePoint from = test::random_start(surface, random).at;
    ShortestPaths tree(surface, from);
    double sum = 0.0;
    int pairs = 0;
    while (pairs < 20) {
        const SurfacePoint to = test::random_start(surface, random).at;
        const PolyhedralPath way = tree.to(to).value();
        if (way.length_mm > 300.0) {
            continue;
        }
        const ConnectResult result = connect(surface, from, to, way);
        expect_reached(surface, result, from, to);
        EXPECT_GE(result.length_mm, way.length_mm * (1.0 - 1e-12));
        sum += result.length_mm - way.length_mm;
        ++pairs;
    }
    std::printf("torus h %4.1f mm: %6zu triangles, %.5f mm longer than the shortest way\n", edge_mm,
                surface.face.size(), sum / pairs);
    return sum / pairs;
}

// The path is off its polyhedral neighbour by second order sideways at most, and length near a
// shortest way is quadratic in that: order 2 is the least to expect.
TEST(ConnectOrder, TorusExcessOverThePolyhedralDistance) {
    const double coarse = torus_excess_mm(16.0);
    const double fine = torus_excess_mm(8.0);
    EXPECT_LT(fine, 0.05);
    EXPECT_GT(coarse / fine, std::exp2(2.0));
}

TEST(ConnectOrder, TeeAgreesWithTheShortestPolyhedralWay) {
    const Surface surface = made("tee", {}, 8.0);
    std::mt19937_64 random(kSeed);
    for (int i = 0; i < 20; ++i) {
        const SurfacePoint a = test::random_start(surface, random).at;
        const SurfacePoint b = test::random_start(surface, random).at;
        const ConnectResult there = connect(surface, a, b);
        const ConnectResult back = connect(surface, b, a);
        expect_reached(surface, there, a, b);
        expect_reached(surface, back, b, a);
        // No path over the facets is shorter than the shortest, to rounding.
        EXPECT_GE(there.length_mm, there.polyhedral_mm * (1.0 - 1e-12));
        EXPECT_NEAR(there.polyhedral_mm, back.polyhedral_mm, 1e-9);
        // The excess is second order: under h^2 / R^2 of the length with the tightest radius, the
        // blend's of 15 mm, on a few edges of the way only. Measured 1.07e-3 at most.
        EXPECT_LE(there.length_mm, there.polyhedral_mm * (1.0 + 1.5e-3));
        EXPECT_NEAR(there.length_mm, back.length_mm, 1e-3 * there.length_mm);
        EXPECT_NEAR(there.path.front().tangent.dot(-back.path.back().tangent), 1.0, 2e-3);
    }
}

// Also with slip, where the reverse path has the opposite ratio.
TEST(ConnectOrder, TeeWithSlipIsReversible) {
    const Surface surface = made("tee", {}, 8.0);
    std::mt19937_64 random(kSeed);
    for (int i = 0; i < 10; ++i) {
        const SurfacePoint a = test::random_start(surface, random).at;
        const SurfacePoint b = test::random_start(surface, random).at;
        const ConnectResult there = connect(surface, a, b, 0.1);
        const ConnectResult back = connect(surface, b, a, -0.1);
        expect_reached(surface, there, a, b);
        expect_reached(surface, back, b, a);
        EXPECT_NEAR(there.length_mm, back.length_mm, 1e-2 * there.length_mm);
    }
}

}  // namespace
}  // namespace meshwind
