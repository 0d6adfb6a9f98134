#include "mesh/surface.h"
#include "mesh/smooth/freeze.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include <gtest/gtest.h>

#include "core/index.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/exact_torus.h"
#include "tests/support/frozen.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct FitErrors {
    double normal_rad = 0.0;        // rms over the corners
    double normal_worst_rad = 0.0;  // largest
    double curvature_per_mm = 0.0;  // rms of the Frobenius norm
    FitReport fit;
};

FitErrors torus_errors(double edge_mm) {
    const Surface surface =
        test::frozen(make_mandrel("torus", {}, {.edge_mm = edge_mm, .irregular = true}));
    const test::ExactTorus torus;
    FitErrors errors{.fit = surface.fit};
    double normals = 0.0;
    double curvatures = 0.0;
    double corners = 0.0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
            const Vector3d& p = surface.position_mm[at(surface.face[f][c])];
            const std::size_t corner = at(surface.corner[f][c]);
            const double tilt = (surface.normal[corner] - torus.normal(p)).norm();
            errors.normal_worst_rad = std::max(errors.normal_worst_rad, tilt);
            normals += tilt * tilt;
            curvatures += (surface.shape_operator_per_mm[corner] - torus.shape_operator_per_mm(p))
                              .squaredNorm();
            corners += 1.0;
        }
    }
    errors.normal_rad = std::sqrt(normals / corners);
    errors.curvature_per_mm = std::sqrt(curvatures / corners);
    return errors;
}

// A fit of degree four leaves the fifth-order term of the height: fourth order in the slope, third
// in the curvature. Half an order is given for the irregular stencils. Measured: normals 9.9e-5,
// 4.3e-6, 2.3e-7 rad (order 4.4), curvatures 4.7e-5, 2.9e-6, 2.4e-7 / mm (order 3.8).
TEST(FreezeSurface, NormalsAreFourthAndCurvaturesThirdOrder) {
    std::vector<FitErrors> errors;
    for (const double edge_mm : {10.0, 5.0, 2.5}) {
        errors.push_back(torus_errors(edge_mm));
        const FitErrors& e = errors.back();
        std::printf(
            "h %4.1f mm: normal rms %.3e worst %.3e rad, curvature rms %.3e / mm, fits %d %d\n",
            edge_mm, e.normal_rad, e.normal_worst_rad, e.curvature_per_mm, e.fit.quartic,
            e.fit.averaged);
    }
    EXPECT_GE(0.5 * std::log2(errors[0].normal_rad / errors[2].normal_rad), 3.5);
    EXPECT_GE(0.5 * std::log2(errors[0].curvature_per_mm / errors[2].curvature_per_mm), 2.5);
    for (const FitErrors& e : errors) {
        EXPECT_EQ(e.fit.averaged, 0);  // no stencil of a closed made mesh is that poor
    }
}

// Two circles of vertices determine neither y^2 nor what it takes with it: the wall is ruled from
// circle to circle. Across it the fit of degree four to three segments either side misses the
// circle's sixth-order term, (3 * 2 pi / 48)^4 / 8 of the curvature; normals are off by 4e-7 rad.
TEST(FreezeSurface, RulesACylinderOfEndCirclesOnly) {
    constexpr int kSegments = 48;
    const Surface surface = test::frozen(test::tube(50.0, 300.0, kSegments, 1));
    EXPECT_EQ(surface.fit.reduced, 2 * kSegments);
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
            Vector3d radial = surface.position_mm[at(surface.face[f][c])];
            radial.z() = 0.0;
            radial.normalize();
            const Vector3d around = Vector3d::UnitZ().cross(radial);
            const std::size_t corner = at(surface.corner[f][c]);
            EXPECT_LT((surface.normal[corner] - radial).norm(), 1e-6);
            const Matrix3d exact = 0.02 * around * around.transpose();
            EXPECT_LT((surface.shape_operator_per_mm[corner] - exact).norm(), 3e-3 * 0.02);
        }
    }
}

// Every fit is counted once: the counts sum to the number of normals.
TEST(FreezeSurface, CountsEveryCorner) {
    for (const char* kind : {"tee", "combination", "vessel"}) {
        const Surface surface = test::frozen(make_mandrel(kind, {}, {.edge_mm = 10.0}));
        EXPECT_EQ(surface.fit.quartic + surface.fit.cubic + surface.fit.quadratic +
                      surface.fit.reduced + surface.fit.averaged,
                  static_cast<int>(surface.normal.size()))
            << kind;
        EXPECT_EQ(surface.normal.size(), surface.shape_operator_per_mm.size());
    }
}

// A pipe's rings of edges: the wall's normal is radial, the end's along z, and none is a blend.
TEST(FreezeSurface, GivesFeatureEdgesOneNormalPerSide) {
    const Surface surface = test::frozen(test::pipe(50.0, 40.0, 100.0, 36));
    // 4 rings of 36 vertices, each with two sides.
    EXPECT_EQ(surface.normal.size(), 4U * 36U * 2U);
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const auto& v = surface.face[f];
        const Vector3d& a = surface.position_mm[at(v[0])];
        const Vector3d facet = (surface.position_mm[at(v[1])] - a)
                                   .cross(surface.position_mm[at(v[2])] - a)
                                   .normalized();
        for (std::size_t c = 0; c < 3; ++c) {
            // At most half a facet's turn (5 deg) away; across the edge it would be 45 deg or more.
            EXPECT_GT(surface.normal[at(surface.corner[f][c])].dot(facet), std::cos(0.1));
        }
    }
}

// A box: three flat sides meet at each vertex, each with its own exact normal and no curvature.
TEST(FreezeSurface, KeepsTheSidesOfABoxFlat) {
    const Surface surface = test::frozen(test::box({0, 0, 0}, {10, 20, 30}));
    EXPECT_EQ(surface.normal.size(), 24U);
    for (const Vector3d& n : surface.normal) {
        EXPECT_NEAR(n.cwiseAbs().maxCoeff(), 1.0, 1e-15);
    }
    for (const Matrix3d& s : surface.shape_operator_per_mm) {
        EXPECT_LT(s.norm(), 1e-15);
    }
}

// The normal is in the kernel of the shape operator, which is symmetric.
TEST(FreezeSurface, ShapeOperatorIsSymmetricAndTangential) {
    const Surface surface =
        test::frozen(make_mandrel("tee", {}, {.edge_mm = 10.0, .irregular = true}));
    for (std::size_t i = 0; i < surface.normal.size(); ++i) {
        const Matrix3d& s = surface.shape_operator_per_mm[i];
        const double scale = 1e-14 * std::max(1.0, s.norm());  // rounding of a few products
        EXPECT_NEAR(surface.normal[i].norm(), 1.0, 1e-14);
        EXPECT_LT((s - s.transpose()).norm(), scale);
        EXPECT_LT((s * surface.normal[i]).norm(), scale);
    }
}

TEST(FreezeSurface, LinksNeighboursBothWays) {
    const Surface surface = test::frozen(make_mandrel("tee", {}, {.edge_mm = 20.0}));
    int open = 0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int32_t g = surface.neighbour[f][e];
            if (g == kNoFace) {
                ++open;
                EXPECT_GE(surface.rim[f][e], 0);
                continue;
            }
            EXPECT_EQ(surface.rim[f][e], -1);
            const auto& back = surface.neighbour[at(g)];
            EXPECT_EQ(std::count(back.begin(), back.end(), static_cast<std::int32_t>(f)), 1);
        }
    }
    EXPECT_GT(open, 0);
}

TEST(FreezeSurface, MeanEdgeIsTheMeanOverTheFaces) {
    // Edges of the box's triangles: each side gives its two edges twice and its diagonal twice.
    const double diagonals = 2.0 * (std::hypot(10, 20) + std::hypot(10, 30) + std::hypot(20, 30));
    const double sides = 2.0 * (10 + 20) + 2.0 * (10 + 30) + 2.0 * (20 + 30);
    const Surface surface = test::frozen(test::box({0, 0, 0}, {10, 20, 30}));
    EXPECT_NEAR(surface.mean_edge_mm, (2.0 * diagonals + 2.0 * sides) / 36.0, 1e-12);
}

TEST(FreezeSurface, AcceptsNoTriangles) {
    const Surface surface = freeze_surface({}, {});
    EXPECT_TRUE(surface.face.empty());
    EXPECT_EQ(surface.mean_edge_mm, 0.0);
}

}  // namespace
}  // namespace meshwind
