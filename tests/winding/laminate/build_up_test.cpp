#include "winding/laminate/build_up.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/mandrel/thicken.h"
#include "mesh/shapes/make_kinds.h"
#include "winding/revolution/pattern_plan.h"

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
    return static_cast<double>(wound.plan.pattern()->pattern.circuits);
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
                            (2.0 * kPi * 40.0 * std::cos(w.plan.pattern()->angle_rad));
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
    const double clairaut = 75.0 * std::sin(w.plan.pattern()->angle_rad);
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
    // Variance along z: of the strip, of the spread, 12^2 / 3, and from faces to their corners.
    EXPECT_EQ(crossing_spread_mm(surface, 6.0), 12.0);
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t v = 0; v < thickness.size(); ++v) {
        const double z = surface.position_mm[v].z();
        sum += thickness[v];
        squares += thickness[v] * z * z;
    }
    EXPECT_NEAR(squares / sum - laid_squares / laid, 48.0 + 2.0 * 2.0 / 6.0, 0.1);
}

constexpr double kRadius_mm = 60.0;
constexpr double kLength_mm = 200.0;

Mandrel pipe(double edge_mm) {
    return build_mandrel(make_mandrel("cylinder", {{"radius", kRadius_mm}, {"length", kLength_mm}},
                                      {.edge_mm = edge_mm}),
                         "cylinder", {.unit_mm = 1.0});
}

// Of each face, from its centre.
template <typename Layers>
std::vector<double> layers_by_place(const Surface& surface, const Layers& layers_at) {
    std::vector<double> layers;
    for (const auto& [a, b, c] : surface.face) {
        layers.push_back(layers_at(Vector3d((surface.position_mm[static_cast<std::size_t>(a)] +
                                             surface.position_mm[static_cast<std::size_t>(b)] +
                                             surface.position_mm[static_cast<std::size_t>(c)]) /
                                            3.0)));
    }
    return layers;
}

// Waves along z whose slope vanishes at both rims, on which holding the rims does nothing. From
// faces to vertices a wave loses about (k edge)^2 / 12 of its height: 0.03 at the shortest here.
TEST(BuildUp, WavesAreDampedByTheirLength) {
    const Mandrel mandrel = pipe(2.0);
    for (const int waves : {2, 5, 10}) {
        const double k_per_mm = 2.0 * kPi * waves / kLength_mm;
        const auto wave = [&](double z_mm) {
            return std::cos(k_per_mm * (z_mm + 0.5 * kLength_mm));
        };
        const auto layers = layers_by_place(
            mandrel.surface, [&](const Vector3d& p) { return 3.0 + 2.0 * wave(p.z()); });
        const auto thickness = build_up_mm(mandrel.surface, layers, 6.0, kThickness_mm);
        const double left = std::pow(1.0 + k_per_mm * k_per_mm * 12.0 * 12.0 / 12.0, -2);
        for (std::size_t v = 0; v < thickness.size(); ++v) {
            const double z_mm = mandrel.surface.position_mm[v].z();
            EXPECT_NEAR(thickness[v], kThickness_mm * (3.0 + 2.0 * left * wave(z_mm)),
                        0.04 * kThickness_mm * 2.0 * left);
        }
    }
}

// A wave around the pipe meets the rims, where it is held with its slope: on a half plane
// (1 - t d2)^2 u = cos(m phi) with u = u' = 0 at the rim is solved by
// u = (1 + t k^2)^-2 (1 - (1 + q z) e^(-q z)) cos(m phi), k = m / R, q^2 = 1 / t + k^2.
TEST(BuildUp, RimsAreHeldWithTheirSlope) {
    const Mandrel mandrel = pipe(2.0);
    const int m = 8;
    const auto layers = layers_by_place(mandrel.surface, [&](const Vector3d& p) {
        return 3.0 + 2.0 * std::cos(m * std::atan2(p.y(), p.x()));
    });
    const auto thickness = build_up_mm(mandrel.surface, layers, 6.0, kThickness_mm);
    const double t_mm2 = 12.0 * 12.0 / 12.0;
    const double k_per_mm = m / kRadius_mm;
    const double q_per_mm = std::sqrt(1.0 / t_mm2 + k_per_mm * k_per_mm);
    const double height_mm = 2.0 * kThickness_mm * std::pow(1.0 + t_mm2 * k_per_mm * k_per_mm, -2);
    double worst_mm = 0.0;
    for (std::size_t v = 0; v < thickness.size(); ++v) {
        const Vector3d& p = mandrel.surface.position_mm[v];
        const double from_rim_mm = 0.5 * kLength_mm - std::abs(p.z());
        const double share =
            1.0 - (1.0 + q_per_mm * from_rim_mm) * std::exp(-q_per_mm * from_rim_mm);
        const double expected =
            3.0 * kThickness_mm + height_mm * share * std::cos(m * std::atan2(p.y(), p.x()));
        worst_mm = std::max(worst_mm, std::abs(thickness[v] - expected));
    }
    EXPECT_LT(worst_mm, 0.05 * height_mm);  // 0.028 with edges of 2 mm
}

// Whatever lies on a pipe, as unevenly as can be, its rims stay circles, which the extensions that
// the next layer turns on go on from.
TEST(BuildUp, RimsStayCircles) {
    const Mandrel mandrel = pipe(5.0);
    std::uint32_t state = 1;  // minimal standard generator
    std::vector<double> layers(mandrel.surface.face.size());
    for (double& count : layers) {
        state = static_cast<std::uint32_t>(std::uint64_t{48271} * state % 2147483647U);
        count = state % 6;
    }
    const auto thickness = build_up_mm(mandrel.surface, layers, 6.0, kThickness_mm);
    const auto [least, most] = std::minmax_element(thickness.begin(), thickness.end());
    EXPECT_GT(*most - *least, 0.1);
    const Mandrel grown = thicken(mandrel, thickness);
    ASSERT_EQ(grown.rims.size(), 2U);
    for (const Rim& rim : grown.rims) {
        EXPECT_LT(rim.circularity_mm, 1e-5);  // as good as the normals that vertices move along
        EXPECT_NEAR(rim.radius_mm, kRadius_mm + 2.5 * kThickness_mm, 0.1);
    }
}

}  // namespace
}  // namespace meshwind
