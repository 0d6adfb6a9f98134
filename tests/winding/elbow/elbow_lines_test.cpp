#include "winding/elbow/elbow_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr ElbowTube kTube{40.0, 120.0, 0.5 * kPi, {150.0, 110.0}};

ElbowOptions at(double angle_deg) {
    return {.alpha0_rad = rad_from_deg(angle_deg), .width_mm = 6.0, .slip = 0.17};
}

// A place in space: leg 1 along +y to the origin's ring, the bend about z, leg 2.
Vector3d place_of(const ElbowTube& tube, const ElbowStation& station) {
    const double bend = tube.bend_mm();
    const double s = station.along_mm - tube.leg_mm[0];
    const double theta = std::clamp(s, 0.0, bend) / tube.ring_radius_mm;
    const Vector3d out(std::cos(theta), std::sin(theta), 0.0);
    const Vector3d way(-std::sin(theta), std::cos(theta), 0.0);
    const double beyond = s - std::clamp(s, 0.0, bend);
    return tube.ring_radius_mm * out + beyond * way +
           tube.tube_radius_mm *
               (std::cos(station.phi_rad) * out + std::sin(station.phi_rad) * Vector3d::UnitZ());
}

// The header's formula by hand: kn = 0 at the inner equator, cos(a)^2 / (R - r) = sin(a)^2 / r.
TEST(ElbowLines, LeastAngleIsWhereTheFibreIsStraightInside) {
    const double outer = least_elbow_angle_rad(kTube);
    const double inner = std::acos(160.0 * std::cos(outer) / 80.0);
    EXPECT_NEAR(std::pow(std::cos(inner), 2) / 80.0, std::pow(std::sin(inner), 2) / 40.0, 1e-15);
    // A little above it the least kn of all lines is that of the inner equator; no station need be
    // just there.
    const ElbowLines lines = elbow_lines(kTube, at(deg_from_rad(outer) + 0.5));
    const double above = std::acos(lines.bend.clairaut_mm() / 80.0);
    const double kn = std::pow(std::sin(above), 2) / 40.0 - std::pow(std::cos(above), 2) / 80.0;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& line : lines.line) {
        for (const ElbowStation& station : line) {
            least = std::min(least, station.kn_per_mm);
        }
    }
    EXPECT_GT(kn, 0.0);
    EXPECT_GE(least, kn - 1e-12);
    EXPECT_NEAR(least, kn, 1e-5);
}

// Tangents and lengths against differences of places in space: chords of 4 mm on a radius of
// 40 mm are short by 4^3 / (24 * 40^2) = 1.7e-3 mm, and their direction is that of the tangent half
// way to second order, h^2 / (12 r^2) = 8e-4.
TEST(ElbowLines, StationsMakeOnePath) {
    const ElbowLines lines = elbow_lines(kTube, at(74.0));
    for (const auto& line : lines.line) {
        EXPECT_NEAR(line.front().along_mm, 0.0, 1e-9);
        EXPECT_NEAR(line.back().along_mm, kTube.length_mm(), 1e-9);
        for (std::size_t i = 1; i < line.size(); ++i) {
            const ElbowStation& a = line[i - 1];
            const ElbowStation& b = line[i];
            const double chord = (place_of(kTube, b) - place_of(kTube, a)).norm();
            ASSERT_GT(b.along_mm, a.along_mm);
            ASSERT_GT(b.phi_rad, a.phi_rad);
            ASSERT_LT(chord, 4.2);
            ASSERT_GE(b.s_mm - a.s_mm, chord - 1e-9);
            ASSERT_LT(b.s_mm - a.s_mm, chord + 2.5e-3);
            // Along the tube: along_mm grows by cos(angle) r / rho of the fibre.
            const auto rate = [&](const ElbowStation& s) {
                const double inside = s.along_mm - kTube.leg_mm[0];
                const bool bent = inside > 1e-6 && inside < kTube.bend_mm() - 1e-6;
                return std::cos(s.angle_rad) *
                       (bent ? 120.0 / (120.0 + 40.0 * std::cos(s.phi_rad)) : 1.0);
            };
            const bool seam = std::abs(a.along_mm - kTube.leg_mm[0]) < 1e-6 ||
                              std::abs(b.along_mm - kTube.leg_mm[0]) < 1e-6 ||
                              std::abs(a.along_mm - kTube.leg_mm[0] - kTube.bend_mm()) < 1e-6 ||
                              std::abs(b.along_mm - kTube.leg_mm[0] - kTube.bend_mm()) < 1e-6;
            if (!seam) {
                ASSERT_NEAR((b.along_mm - a.along_mm) / (b.s_mm - a.s_mm),
                            0.5 * (rate(a) + rate(b)), 1e-3);
            }
        }
    }
}

TEST(ElbowLines, AreGeodesicsOnTheBendAndMeetTheLegsThere) {
    const ElbowLines lines = elbow_lines(kTube, at(74.0));
    const double c = lines.bend.clairaut_mm();
    const std::vector<TorusLine> torus = torus_lines(lines.bend, lines.count());
    for (std::size_t i = 0; i < lines.line.size(); ++i) {
        for (const ElbowStation& station : lines.line[i]) {
            const double s = station.along_mm - kTube.leg_mm[0];
            if (s > -1e-9 && s < kTube.bend_mm() + 1e-9) {
                EXPECT_NEAR(
                    (120.0 + 40.0 * std::cos(station.phi_rad)) * std::cos(station.angle_rad), c,
                    1e-9);
            }
            if (std::abs(s) < 1e-9) {
                EXPECT_NEAR(station.phi_rad, torus[i].phi_minus_rad, 1e-9);
            }
            if (std::abs(s - kTube.bend_mm()) < 1e-9) {
                EXPECT_NEAR(station.phi_rad, torus[i].phi_plus_rad, 1e-9);
            }
        }
    }
}

// kg = d angle / ds on a cylinder, by differences of stations; |kg| <= slip sin(angle)^2 / r. Half
// the difference of sin^2 over a step of 0.1 rad is a tenth of it, and less than 2 % as the mean of
// both ends.
TEST(ElbowLines, LegsAreSteeredWithinTheSlip) {
    for (const double angle : {70.0, 74.0, 78.0}) {
        const ElbowLines lines = elbow_lines(kTube, at(angle));
        double worst = 0.0;
        for (const auto& line : lines.line) {
            for (std::size_t i = 1; i < line.size(); ++i) {
                const ElbowStation& a = line[i - 1];
                const ElbowStation& b = line[i];
                if (b.along_mm > kTube.leg_mm[0] + 1e-9 &&
                    a.along_mm < kTube.leg_mm[0] + kTube.bend_mm() - 1e-9) {
                    continue;
                }
                const double middle =
                    0.5 * (std::pow(std::sin(a.angle_rad), 2) + std::pow(std::sin(b.angle_rad), 2));
                worst = std::max(
                    worst, std::abs(b.angle_rad - a.angle_rad) / (b.s_mm - a.s_mm) * 40.0 / middle);
            }
        }
        EXPECT_LE(worst, 0.17 * 1.02) << angle;
        const double stated = std::max(lines.leg[0].slip, lines.leg[1].slip);
        EXPECT_NEAR(worst, stated, 0.03 * stated) << angle;
    }
}

TEST(ElbowLines, EndEvenlyAndAtOneAngle) {
    const ElbowLines lines = elbow_lines(kTube, at(74.0));
    const int count = lines.count();
    EXPECT_EQ(lines.needed, lines_for_tape(lines.bend, 6.0));
    for (std::size_t end = 0; end < 2; ++end) {
        ASSERT_EQ(lines.leg[end].even, 1.0);
        EXPECT_EQ(lines.leg[end].closed_mm, kTube.leg_mm[end]);
        const auto last = [&](int i) {
            const auto& line = lines.line[static_cast<std::size_t>(i)];
            return end == 0 ? line.front() : line.back();
        };
        for (int i = 0; i < count; ++i) {
            EXPECT_NEAR(last(i).angle_rad, lines.leg[end].angle_rad, 1e-9);
            // phi where a line leaves the tube falls with its number.
            EXPECT_NEAR(last(0).phi_rad - last(i).phi_rad, 2.0 * kPi * i / count, 1e-8);
        }
    }
}

// No place on a line is farther from the next line than the width: distances in space, to chords of
// 2 mm, 0.01 mm off. Not over the surface, so shorter by up to 6^3 / (24 * 40^2) = 0.006 mm.
TEST(ElbowLines, NeighboursAreNoFartherApartThanTheWidth) {
    for (const double layers : {1.0, 2.0}) {
        ElbowOptions options = at(74.0);
        options.layers = layers;
        options.station_mm = 2.0;
        const ElbowLines lines = elbow_lines(kTube, options);
        std::vector<std::vector<Vector3d>> places(lines.line.size());
        for (std::size_t i = 0; i < places.size(); ++i) {
            for (const ElbowStation& station : lines.line[i]) {
                places[i].push_back(place_of(kTube, station));
            }
        }
        double widest = 0.0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto& next = places[(i + 1) % places.size()];
            for (std::size_t n = 0; n < places[i].size(); ++n) {
                // Not beyond the rims.
                const double along = lines.line[i][n].along_mm;
                if (along < 12.0 || along > kTube.length_mm() - 12.0) {
                    continue;
                }
                const Vector3d& here = places[i][n];
                double least = std::numeric_limits<double>::infinity();
                for (std::size_t k = 1; k < next.size(); ++k) {
                    const Vector3d chord = next[k] - next[k - 1];
                    const double share =
                        std::clamp((here - next[k - 1]).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
                    least = std::min(least, (here - next[k - 1] - share * chord).norm());
                }
                widest = std::max(widest, least);
            }
        }
        EXPECT_LT(widest, 6.0 / layers + 0.03) << layers;
        EXPECT_GT(widest, 0.9 * 6.0 / layers) << layers;
        const double outside = lines.spacing_mm(0.0);
        EXPECT_LE(outside, 6.0 / layers);
    }
}

TEST(ElbowLines, WithoutLegsItIsThePaper) {
    const ElbowTube tube{5.0, 20.0, rad_from_deg(120.0), {0.0, 0.0}};
    ElbowOptions options{.alpha0_rad = rad_from_deg(78.0), .width_mm = 0.5};
    const ElbowLines lines = elbow_lines(tube, options);
    EXPECT_EQ(lines.count(), 23);
    EXPECT_NEAR(lines.theta_cycle_rad, 0.470065087963, 1e-12);
    EXPECT_NEAR(lines.line[0].back().s_mm, 150.687207393123, 1e-8);
}

// Without friction nothing is steered: lines cross on one side and leave a gap on the other.
TEST(ElbowLines, SayHowFarLegsAreClosedWithoutFriction) {
    ElbowOptions options = at(74.0);
    options.slip = 0.0;
    const ElbowLines lines = elbow_lines(kTube, options);
    EXPECT_EQ(lines.leg[0].even, 0.0);
    EXPECT_EQ(lines.leg[0].slip, 0.0);
    EXPECT_LT(lines.leg[0].closed_mm, 100.0);
    EXPECT_GT(lines.leg[0].widest_mm, 6.0);
    EXPECT_EQ(lines.count(), lines.needed * 3 / 2);
}

TEST(ElbowLines, RefusesLinesThatDoNotPass) {
    EXPECT_THROW((void)elbow_lines(kTube, at(50.0)), InputError);
    EXPECT_THROW((void)elbow_lines({130.0, 120.0, 1.0, {}}, at(80.0)), InputError);
}

}  // namespace
}  // namespace meshwind
