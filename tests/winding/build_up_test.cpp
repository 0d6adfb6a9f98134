#include "winding/build_up.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/make_kinds.h"
#include "winding/pattern_plan.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kThickness_mm = 0.25;
constexpr Tow kTow{.width_mm = 6.0, .thickness_mm = kThickness_mm, .friction = 0.2};

struct Wound {
    Mandrel mandrel;
    BodyOfRevolution body;
    Plan plan;
};

Wound wound(const char* kind, const MakeValues& values, PatternOptions options) {
    Mandrel mandrel =
        build_mandrel(make_mandrel(kind, values, {.edge_mm = 4.0}), kind, {.unit_mm = 1.0});
    BodyOfRevolution body = *find_revolution(mandrel).body;
    options.tow = kTow;
    Plan plan = plan_pattern(mandrel, body, options);
    EXPECT_EQ(plan.failure, "");
    return {std::move(mandrel), std::move(body), std::move(plan)};
}

double circuits_of(const Wound& wound) {
    return static_cast<double>(wound.plan.pattern->pattern.circuits);
}

double volume_mm3(const Surface& surface, const std::vector<double>& thickness_mm) {
    double sum = 0.0;
    for (const auto& [a, b, c] : surface.face) {
        const auto i = static_cast<std::size_t>(a);
        const auto j = static_cast<std::size_t>(b);
        const auto k = static_cast<std::size_t>(c);
        const Vector3d& p = surface.position_mm[i];
        const double area =
            0.5 * (surface.position_mm[j] - p).cross(surface.position_mm[k] - p).norm();
        sum += area * (thickness_mm[i] + thickness_mm[j] + thickness_mm[k]) / 3.0;
    }
    return sum;
}

// 2 N bands of w / cos(angle) of the circumference, everywhere.
TEST(BuildUp, IsEvenOnACylinder) {
    const Wound w = wound("cylinder", {{"radius", 40.0}, {"length", 150.0}}, {});
    const double expected = kThickness_mm * 2.0 * circuits_of(w) * kTow.width_mm /
                            (2.0 * kPi * 40.0 * std::cos(w.plan.pattern->angle_rad));
    for (const double t : regular_build_up_mm(w.mandrel.surface, w.body, w.plan.pieces,
                                              kTow.width_mm, kThickness_mm)) {
        EXPECT_NEAR(t, expected, 1e-9);
    }
}

// On a dome the layers grow as 1 / (r cos a), with Clairaut's angle; away from the turn the spread
// changes little: by its variance times half the second derivative.
TEST(BuildUp, FollowsClairautOnADome) {
    const Wound w = wound("vessel",
                          {{"radius", 75.0},
                           {"cylinder-length", 100.0},
                           {"dome-height", 75.0},
                           {"opening-radius", 15.0}},
                          {.kind = PatternKind::Polar});
    const auto thickness =
        regular_build_up_mm(w.mandrel.surface, w.body, w.plan.pieces, kTow.width_mm, kThickness_mm);
    const double clairaut = 75.0 * std::sin(w.plan.pattern->angle_rad);
    int compared = 0;
    for (std::size_t v = 0; v < thickness.size(); ++v) {
        const Vector3d& p = w.mandrel.surface.position_mm[v];
        const double r = std::hypot(p.x(), p.y());
        if (r < 2.5 * clairaut) {
            continue;
        }
        const double expected = kThickness_mm * 2.0 * circuits_of(w) * kTow.width_mm /
                                (2.0 * kPi * std::sqrt(r * r - clairaut * clairaut));
        EXPECT_NEAR(thickness[v], expected, 0.01 * expected);
        ++compared;
    }
    EXPECT_GT(compared, 1000);
    const double most = *std::max_element(thickness.begin(), thickness.end());
    EXPECT_GT(most, 4.0 * *std::min_element(thickness.begin(), thickness.end()));
    // All the fibre lies on the wall: none of it turns beyond.
    const double laid = w.plan.fibre_length_mm * kTow.width_mm * kThickness_mm;
    EXPECT_NEAR(volume_mm3(w.mandrel.surface, thickness), laid, 0.02 * laid);
}

TEST(BuildUp, DiffusionKeepsTheVolumeAndSpreadsByThePlan) {
    const Mandrel sheet = build_mandrel(
        make_mandrel("cylinder", {{"radius", 60.0}, {"length", 200.0}}, {.edge_mm = 2.0}),
        "cylinder", {.unit_mm = 1.0});
    const Surface& surface = sheet.surface;
    std::vector<double> layers(surface.face.size(), 0.0);
    double laid = 0.0;
    double laid_squares = 0.0;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        double z = 0.0;
        for (const std::int32_t v : surface.face[f]) {
            z += surface.position_mm[static_cast<std::size_t>(v)].z() / 3.0;
        }
        layers[f] = std::abs(z) < 10.0 ? 3.0 : 0.0;
        const Vector3d& p = surface.position_mm[static_cast<std::size_t>(surface.face[f][0])];
        const double volume =
            layers[f] * kThickness_mm * 0.5 *
            (surface.position_mm[static_cast<std::size_t>(surface.face[f][1])] - p)
                .cross(surface.position_mm[static_cast<std::size_t>(surface.face[f][2])] - p)
                .norm();
        laid += volume;
        laid_squares += volume * z * z;
    }
    const auto thickness = build_up_mm(surface, layers, 6.0, kThickness_mm);
    EXPECT_NEAR(volume_mm3(surface, thickness), laid, 1e-6 * laid);
    // Variance along z: of the strip, of the spread, 6^2 / 3, and from faces to their corners.
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t v = 0; v < thickness.size(); ++v) {
        const double z = surface.position_mm[v].z();
        sum += thickness[v];
        squares += thickness[v] * z * z;
    }
    EXPECT_NEAR(squares / sum - laid_squares / laid, 12.0 + 2.0 * 2.0 / 6.0, 0.1);
}

}  // namespace
}  // namespace meshwind
