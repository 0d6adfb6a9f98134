#include "winding/laminate/plies.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "tests/support/fixtures.h"
#include "winding/laminate/material_axes.h"
#include "winding/revolution/pattern_plan.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr Tow kTow{.width_mm = 6.0, .thickness_mm = 0.25, .friction = 0.2};
constexpr double kRadius_mm = 40.0;

struct Wound {
    Mandrel mandrel;
    Plan plan;
    Plies plies;
};

Wound wound(PatternKind kind, double edge_mm) {
    Mandrel mandrel = test::made_cylinder(kRadius_mm, 150.0, edge_mm);
    const BodyOfRevolution body = *find_revolution(mandrel).body;
    PatternOptions options;
    options.kind = kind;
    options.angle_rad = rad_from_deg(45.0);
    options.tow = kTow;
    Plan plan = plan_pattern(mandrel, body, options);
    EXPECT_EQ(plan.failure, "");
    Plies plies = plies_of(mandrel.surface, mandrel.surface, plan.pieces,
                           {.tow_width_mm = kTow.width_mm, .seed = options.context.seed});
    return {std::move(mandrel), std::move(plan), std::move(plies)};
}

Vector3d twice_area(const Surface& surface, std::size_t f) {
    const auto corner = [&](std::size_t k) {
        return surface.position_mm[static_cast<std::size_t>(surface.face[f][k])];
    };
    return (corner(1) - corner(0)).cross(corner(2) - corner(0));
}

void expect_same_layers(const Wound& w) {
    double covered = 0.0;
    double samples = 0.0;
    double layers = 0.0;
    for (std::size_t f = 0; f < w.plan.face_layers.size(); ++f) {
        double sum = 0.0;
        double thickest = 0.0;
        std::int32_t piece = -1;
        for (const Ply& ply : w.plies.of(f)) {
            EXPECT_EQ(w.plan.pieces[static_cast<std::size_t>(ply.piece)].kind, PieceKind::Course);
            EXPECT_GE(ply.piece, piece);  // in winding order
            EXPECT_GT(ply.share, 0.0);
            EXPECT_LE(ply.share, 1.0 + 1e-12);
            EXPECT_NEAR(ply.along.norm(), 1.0, 1e-9);
            piece = ply.piece;
            sum += ply.share;
            thickest = std::max(thickest, ply.share);
        }
        EXPECT_NEAR(sum, w.plan.face_layers[f], 1e-9);
        EXPECT_GE(w.plies.covered[f], thickest - 1e-9);
        EXPECT_LE(w.plies.covered[f], std::min(1.0, sum) + 1e-9);
        covered += w.plies.samples[f] * w.plies.covered[f];
        layers += w.plies.samples[f] * sum;
        samples += w.plies.samples[f];
    }
    EXPECT_NEAR(covered / samples, w.plan.coverage.fraction, 1e-9);
    EXPECT_NEAR(layers / samples, w.plan.coverage.mean_layers, 1e-9);
}

TEST(Plies, AddUpToTheMeasuredLayers) {
    expect_same_layers(wound(PatternKind::Helical, 6.0));
}

// Most triangles have no sample then.
TEST(Plies, AddUpOnTrianglesWithoutSamples) {
    const Wound w = wound(PatternKind::Helical, 1.2);
    EXPECT_GT(std::count(w.plies.samples.begin(), w.plies.samples.end(), 0),
              static_cast<std::ptrdiff_t>(w.plies.samples.size() / 3));
    expect_same_layers(w);
}

// 2 N bands, w / cos(angle) of the circumference each, half of either hand.
TEST(Plies, OfAHelicalLayerAreOfBothHands) {
    const Wound w = wound(PatternKind::Helical, 6.0);
    const std::vector<Vector3d> axes = material_axes(w.mandrel);
    double volume = 0.0;
    double area = 0.0;
    double left = 0.0;
    for (std::size_t f = 0; f < axes.size(); ++f) {
        const Vector3d twice = twice_area(w.mandrel.surface, f);
        area += 0.5 * twice.norm();
        for (const Ply& ply : w.plies.of(f)) {
            const double angle = ply_angle_rad(axes[f], twice.normalized(), ply.along);
            EXPECT_NEAR(std::abs(angle), w.plan.pattern()->angle_rad, rad_from_deg(0.5));
            volume += 0.5 * twice.norm() * ply.share;
            left += 0.5 * twice.norm() * (angle > 0.0 ? ply.share : 0.0);
        }
    }
    const auto circuits = static_cast<double>(w.plan.pattern()->pattern.circuits);
    const double expected = 2.0 * circuits * kTow.width_mm /
                            (2.0 * kPi * kRadius_mm * std::cos(w.plan.pattern()->angle_rad));
    EXPECT_NEAR(volume / area / expected, 1.0, 0.02);  // of the samples at the bands' edges
    EXPECT_NEAR(left / volume, 0.5, 0.01);
}

// One course that goes round many times: each time over a triangle is a ply.
TEST(Plies, OfHoopsAreOneForEachTimeRound) {
    const Wound w = wound(PatternKind::Hoop, 12.0);
    expect_same_layers(w);
    ASSERT_EQ(w.plan.courses, 1);
    // Facets are 10 mm high: under at least two bands of 6 mm, and no more than four.
    for (std::size_t f = 0; f < w.mandrel.surface.face.size(); ++f) {
        EXPECT_GE(w.plies.of(f).size(), 2U);
        EXPECT_LE(w.plies.of(f).size(), 4U);
    }
}

// On a crease a path has two stations at one place, and turns there: a place beside them is by the
// first.
TEST(Plies, HaveADirectionWherePathsCrossCreases) {
    Wound w = wound(PatternKind::Helical, 6.0);
    for (Piece& piece : w.plan.pieces) {
        SurfacePath creased;
        for (const PathPoint& point : piece.path) {
            creased.push_back(point);
            creased.push_back(point);
            creased.back().tangent =
                Eigen::AngleAxisd(0.2, point.normal).toRotationMatrix() * point.tangent;
        }
        piece.path = std::move(creased);
    }
    const Plies plies = plies_of(w.mandrel.surface, w.mandrel.surface, w.plan.pieces,
                                 {.tow_width_mm = kTow.width_mm, .seed = 1});
    ASSERT_FALSE(plies.ply.empty());
    for (const Ply& ply : plies.ply) {
        ASSERT_NEAR(ply.along.norm(), 1.0, 1e-9);
    }
}

TEST(Plies, OfNoFibreAreNone) {
    const Mandrel mandrel = test::made_cylinder(kRadius_mm, 60.0, 10.0);
    const Plies plies = plies_of(mandrel.surface, mandrel.surface, {}, {.tow_width_mm = 6.0});
    EXPECT_TRUE(plies.ply.empty());
    EXPECT_EQ(plies.begin, std::vector<std::size_t>(mandrel.surface.face.size() + 1, 0));
    EXPECT_EQ(plies.covered, std::vector<double>(mandrel.surface.face.size(), 0.0));
}

}  // namespace
}  // namespace meshwind
