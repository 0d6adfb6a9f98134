// How fast the error of traces falls with the edge length, against independent solutions.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>
#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/GeodesicExact.hpp>

#include "mesh/make_kinds.h"
#include "reference.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kSeed = 40;
constexpr int kStarts = 40;

// Observed order between an edge length and a quarter of it.
double order(double coarse, double fine) {
    return 0.5 * std::log2(coarse / fine);
}

double torus_error_mm(double edge_mm, double length_mm, double slip_ratio) {
    const Surface surface =
        test::frozen(make_mandrel("torus", {}, {.edge_mm = edge_mm, .irregular = true}));
    const test::ExactTorus torus;
    std::mt19937_64 random(kSeed);
    double squares = 0.0;
    double worst = 0.0;
    for (int i = 0; i < kStarts; ++i) {
        const test::Start start = test::random_start(surface, random);
        const Vector3d p = torus.foot(position_mm(surface, start.at));
        const Vector3d n = torus.normal(p);
        const Vector3d t = (start.direction - n * n.dot(start.direction)).normalized();
        const test::CurveState exact = test::follow(torus, {p, t}, length_mm, slip_ratio);
        const TraceOptions options{.max_length_mm = length_mm};
        const TraceResult traced = trace(surface, start.at, t, {slip_ratio, slip_ratio}, options);
        test::expect_sound(surface, traced, options);
        const double error = (traced.path.back().position_mm - exact.position_mm).norm();
        squares += error * error;
        worst = std::max(worst, error);
    }
    const double rms = std::sqrt(squares / kStarts);
    std::printf("torus h %4.1f mm, lambda %.1f: %6zu triangles, rms %.4f mm, worst %.4f mm\n",
                edge_mm, slip_ratio, surface.face.size(), rms, worst);
    return rms;
}

// Another implementation of the method gave 6.8, 1.49, 0.42 and 0.109 mm on other irregular meshes
// and starts (straightest paths on facets: 24.1, 8.8, 3.6, 2.0). Here 10.9, 1.51, 0.31 and 0.074 mm
// were measured. Allowed is 1.5 times the other's; 1.75 at 20 mm, where a fit spans 40 mm of a tube
// of radius 50 mm and the scatter of 40 starts is largest.
TEST(TraceOrder, TorusGeodesics) {
    EXPECT_LE(torus_error_mm(20.0, 600.0, 0.0), 1.75 * 6.8);
    const double coarse = torus_error_mm(10.0, 600.0, 0.0);
    EXPECT_LE(coarse, 1.5 * 1.49);
    EXPECT_LE(torus_error_mm(5.0, 600.0, 0.0), 1.5 * 0.42);
    const double fine = torus_error_mm(2.5, 600.0, 0.0);
    EXPECT_LE(fine, 1.5 * 0.109);
    EXPECT_GE(order(coarse, fine), 2.0);  // measured 2.17
}

// Measured 27.2, 7.35, 1.89 and 0.449 mm, order 2.02: the curvature of the fits is second order and
// of one sign on a tube (0.6 % too high at h = 5), so it adds up. Bounds: 1.3 times what was
// measured.
TEST(TraceOrder, TorusSteered) {
    EXPECT_LE(torus_error_mm(20.0, 600.0, 0.1), 1.3 * 27.2);
    const double coarse = torus_error_mm(10.0, 600.0, 0.1);
    EXPECT_LE(coarse, 1.3 * 7.35);
    EXPECT_LE(torus_error_mm(5.0, 600.0, 0.1), 1.3 * 1.89);
    const double fine = torus_error_mm(2.5, 600.0, 0.1);
    EXPECT_LE(fine, 1.3 * 0.449);
    EXPECT_GE(order(coarse, fine), 1.9);
}

struct Spheroid {
    double equator_radius_mm;
    double pole_radius_mm;

    [[nodiscard]] double flattening() const { return 1.0 - pole_radius_mm / equator_radius_mm; }
};

// Geodesic by GeographicLib: 15 digits on any flattening.
Vector3d exact_end_mm(const Spheroid& shape, const ShapeFoot& foot, const Vector3d& tangent,
                      double length_mm) {
    const double lat = std::asin(foot.normal.z());
    const double lon = std::atan2(foot.normal.y(), foot.normal.x());
    const Vector3d east(-std::sin(lon), std::cos(lon), 0.0);
    const Vector3d north = foot.normal.cross(east);
    const double azimuth = std::atan2(tangent.dot(east), tangent.dot(north));
    const GeographicLib::GeodesicExact solver(shape.equator_radius_mm, shape.flattening());
    double lat2 = 0.0;
    double lon2 = 0.0;
    solver.Direct(deg_from_rad(lat), deg_from_rad(lon), deg_from_rad(azimuth), length_mm, lat2,
                  lon2);
    Vector3d end;
    GeographicLib::Geocentric(shape.equator_radius_mm, shape.flattening())
        .Forward(lat2, lon2, 0.0, end.x(), end.y(), end.z());
    return end;
}

double spheroid_error_mm(const Spheroid& shape, double edge_mm, double length_mm) {
    const MakeValues values{{"equator-radius", shape.equator_radius_mm},
                            {"pole-radius", shape.pole_radius_mm}};
    const Surface surface =
        test::frozen(make_mandrel("ellipsoid", values, {.edge_mm = edge_mm, .irregular = true}));
    std::mt19937_64 random(kSeed);
    double squares = 0.0;
    for (int i = 0; i < kStarts; ++i) {
        const test::Start start = test::random_start(surface, random);
        const ShapeFoot foot = mandrel_foot("ellipsoid", values, position_mm(surface, start.at));
        const Vector3d t =
            (start.direction - foot.normal * foot.normal.dot(start.direction)).normalized();
        const TraceResult traced = trace(surface, start.at, t, {}, {.max_length_mm = length_mm});
        squares += (traced.path.back().position_mm - exact_end_mm(shape, foot, t, length_mm))
                       .squaredNorm();
    }
    const double rms = std::sqrt(squares / kStarts);
    std::printf("spheroid %.0f x %.0f, h %4.1f mm: %6zu triangles, rms %.4f mm\n",
                shape.equator_radius_mm, shape.pole_radius_mm, edge_mm, surface.face.size(), rms);
    return rms;
}

// Measured: oblate 0.551, 0.136, 0.033 mm, prolate 0.677, 0.173, 0.042 mm over 400 mm, order 2.0:
// the facets' way is short by about h^2 / (24 r^2) of itself, and neighbouring geodesics meet
// again.
TEST(TraceOrder, SpheroidGeodesicsAgreeWithGeographicLib) {
    for (const Spheroid& shape : {Spheroid{100.0, 75.0}, Spheroid{75.0, 100.0}}) {
        const double coarse = spheroid_error_mm(shape, 10.0, 400.0);
        const double fine = spheroid_error_mm(shape, 2.5, 400.0);
        EXPECT_LE(coarse, 0.9);
        EXPECT_LE(fine, 0.06);
        EXPECT_GE(order(coarse, fine), 1.9);
    }
}

}  // namespace
}  // namespace meshwind
