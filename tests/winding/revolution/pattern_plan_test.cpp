#include "winding/revolution/pattern_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/revolution/revolution.h"
#include "tests/support/fixtures.h"
#include "tests/support/tells.h"
#include "winding/turn/turn.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// The mesh's patches are off the ideal surface by fourth order in edges of 5 mm.
constexpr double kOnWall_mm = 0.01;

// "closes within 0.01 deg"
constexpr double kClosure_rad = rad_from_deg(0.01);

constexpr Tow kTow{.width_mm = 6.0, .thickness_mm = 0.25, .friction = 0.2};

const MakeValues kVessel{
    {"radius", 50.0}, {"cylinder-length", 80.0}, {"dome-height", 35.0}, {"opening-radius", 12.0}};

struct Planned {
    Mandrel mandrel;
    BodyOfRevolution body;
    Plan plan;
};

Planned planned(Mandrel mandrel, PatternOptions options) {
    options.turn.extension_mm = 150.0;
    RevolutionFinding found = find_revolution(mandrel);
    EXPECT_TRUE(found.body.has_value()) << found.why_not;
    Plan plan = plan_pattern(mandrel, *found.body, options);
    return {std::move(mandrel), std::move(*found.body), std::move(plan)};
}

double radius_of(const Vector3d& p) {
    return std::hypot(p.x(), p.y());
}

// Stations follow one another as arc lengths say, and pieces join in place and direction.
void expect_one_fibre(const Plan& plan) {
    ASSERT_EQ(plan.failure, "");
    ASSERT_FALSE(plan.pieces.empty());
    EXPECT_LT(plan.worst_joint_mm, kOnWall_mm);
    for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
        const SurfacePath& path = plan.pieces[i].path;
        for (std::size_t k = 1; k < path.size(); ++k) {
            const double ds = path[k].s_mm - path[k - 1].s_mm;
            const double chord = (path[k].position_mm - path[k - 1].position_mm).norm();
            ASSERT_NEAR(chord, ds, 0.05) << "piece " << i << " station " << k;
        }
        if (i > 0) {
            const PathPoint& from = plan.pieces[i - 1].path.back();
            EXPECT_GT(from.tangent.dot(path.front().tangent), 1.0 - 1e-4) << "piece " << i;
        }
    }
}

void expect_closed(const Plan& plan) {
    ASSERT_TRUE(plan.pattern() != nullptr);
    const Pattern& pattern = plan.pattern()->pattern;
    EXPECT_EQ(std::gcd(pattern.circuits, pattern.turns), 1);
    EXPECT_LT(plan.pattern()->closure_rad, kClosure_rad);
    EXPECT_EQ(plan.courses, 2 * pattern.circuits);
    // Circuits start evenly around, each place once.
    std::vector<double> starts;
    bool up = true;
    for (const Piece& piece : plan.pieces) {
        if (piece.kind == PieceKind::Course) {
            if (up) {
                const Vector3d& first = piece.path.front().position_mm;
                starts.push_back(std::atan2(first.y(), first.x()));
            }
            up = !up;
        }
    }
    std::sort(starts.begin(), starts.end());
    ASSERT_EQ(starts.size(), static_cast<std::size_t>(pattern.circuits));
    for (std::size_t i = 1; i < starts.size(); ++i) {
        EXPECT_NEAR(starts[i] - starts[i - 1], pattern.step_rad, kClosure_rad);
    }
}

TEST(PatternPlan, HelicesOnACylinderCloseByDwell) {
    for (const double angle_deg : {45.0, 60.0, 75.0}) {
        const Planned p = planned(test::made_cylinder(40.0, 200.0, 5.0),
                                  {.angle_rad = rad_from_deg(angle_deg), .tow = kTow});
        expect_one_fibre(p.plan);
        expect_closed(p.plan);
        const double bands = 2.0 * kPi * 40.0 * std::cos(rad_from_deg(angle_deg)) / kTow.width_mm;
        EXPECT_GE(p.plan.pattern()->pattern.circuits, bands);
        EXPECT_LE(p.plan.pattern()->pattern.circuits, 1.1 * bands + 1.0);
        EXPECT_GT(p.plan.coverage.fraction, 0.999) << angle_deg;
        EXPECT_NEAR(p.plan.coverage.mean_layers,
                    2.0 * static_cast<double>(p.plan.pattern()->pattern.circuits) / bands, 0.05);
        for (const Piece& piece : p.plan.pieces) {
            EXPECT_LE(piece.worst_slip, kTow.friction.holds()) << angle_deg;
            if (piece.kind == PieceKind::Course) {
                for (const PathPoint& at : piece.path) {
                    EXPECT_NEAR(std::abs(at.tangent.z()), std::cos(rad_from_deg(angle_deg)), 1e-3);
                }
            }
        }
    }
}

TEST(PatternPlan, PolarCoursesTouchTheOpenings) {
    const Planned p =
        planned(test::made("vessel", kVessel, 5.0), {.kind = PatternKind::Polar, .tow = kTow});
    expect_one_fibre(p.plan);
    expect_closed(p.plan);
    double least = 1e9;
    for (const Piece& piece : p.plan.pieces) {
        EXPECT_EQ(piece.kind, PieceKind::Course);
        for (const PathPoint& at : piece.path) {
            least = std::min(least, radius_of(at.position_mm));
            // Clairaut.
            const Vector3d around = Vector3d::UnitZ().cross(at.position_mm);
            EXPECT_NEAR(around.dot(at.tangent), 50.0 * std::sin(p.plan.pattern()->angle_rad), 0.05);
        }
    }
    // But for what closing the pattern changes the angle.
    EXPECT_NEAR(least, 12.0 + 0.5 * kTow.width_mm, 50.0 * rad_from_deg(3.0));
    EXPECT_NEAR(p.plan.coverage.fraction, p.plan.coverage.reachable, 1e-3);
    EXPECT_EQ(p.plan.pattern()->pattern.dwell_rad, 0.0);
}

TEST(PatternPlan, HelicesOnAVesselTurnByThemselves) {
    const Planned p =
        planned(test::made("vessel", kVessel, 5.0), {.angle_rad = rad_from_deg(40.0), .tow = kTow});
    expect_one_fibre(p.plan);
    expect_closed(p.plan);
    EXPECT_NEAR(p.plan.pattern()->angle_rad, rad_from_deg(40.0), rad_from_deg(3.0));
    EXPECT_LT(p.plan.worst_slip, 0.1);
}

// They close by giving way to the angle, and bands at another angle lie farther apart: what is laid
// closes the wall, and is what the figures say.
TEST(PatternPlan, HelicesOnAVesselLeaveNoGaps) {
    const Mandrel vessel = test::made("vessel", kVessel, 5.0);
    const double radius_mm =
        find_revolution(vessel)
            .body->meridian.at(find_revolution(vessel).body->meridian.widest_mm())
            .radius_mm;
    for (const double angle_deg : {35.0, 45.0, 55.0, 65.0, 70.0, 75.0}) {
        SCOPED_TRACE(angle_deg);
        const Plan plan = planned(vessel, {.angle_rad = rad_from_deg(angle_deg), .tow = kTow}).plan;
        ASSERT_EQ(plan.failure, "");
        const LaidPattern& laid = *plan.pattern();
        const double deep = static_cast<double>(laid.pattern.circuits) * kTow.width_mm /
                            (2.0 * kPi * radius_mm * std::cos(laid.angle_rad));
        EXPECT_GE(deep, 1.0 - 1e-3);
        EXPECT_NEAR(laid.pattern.overlap, deep - 1.0, 1e-6);
    }
}

// Azimuth that a pass of the plan has wound at its ends and where it begins, about +Z.
struct PassAround {
    double begin_rad = 0.0;
    double wound_rad = 0.0;
};

std::vector<PassAround> passes_of(const Plan& plan) {
    std::vector<PassAround> passes;
    for (const Piece& piece : plan.pieces) {
        if (piece.kind != PieceKind::Course) {
            continue;
        }
        PassAround& pass = passes.emplace_back();
        const auto azimuth = [](const PathPoint& p) {
            return std::atan2(p.position_mm.y(), p.position_mm.x());
        };
        pass.begin_rad = azimuth(piece.path.front());
        for (std::size_t i = 1; i < piece.path.size(); ++i) {
            pass.wound_rad +=
                std::remainder(azimuth(piece.path[i]) - azimuth(piece.path[i - 1]), 2.0 * kPi);
        }
    }
    return passes;
}

// Helices of either hand cross wherever both azimuths, which run against one another, are equal;
// where a fibre turns by itself its own two passes meet without crossing.
std::int64_t crossings_of(const Plan& plan) {
    const std::vector<PassAround> passes = passes_of(plan);
    std::int64_t count = 0;
    for (std::size_t up = 0; up < passes.size(); up += 2) {
        for (std::size_t down = 1; down < passes.size(); down += 2) {
            const double at_bottom =
                passes[down].begin_rad + passes[down].wound_rad - passes[up].begin_rad;
            const double at_top =
                passes[down].begin_rad - passes[up].begin_rad - passes[up].wound_rad;
            constexpr double kMeet_rad = 1e-7;
            count += static_cast<std::int64_t>(std::floor((at_bottom - kMeet_rad) / (2.0 * kPi)) -
                                               std::floor((at_top + kMeet_rad) / (2.0 * kPi)));
        }
    }
    return count;
}

TEST(PatternPlan, LatticesAreRibsWithWallBetween) {
    PatternOptions options{.angle_rad = rad_from_deg(50.0), .tow = kTow};
    options.lattice = LatticeConstraints{.circuits = 6};
    const Planned p = planned(test::made_cylinder(40.0, 200.0, 5.0), options);
    expect_one_fibre(p.plan);
    expect_closed(p.plan);
    const LaidPattern& laid = *p.plan.pattern();
    EXPECT_EQ(laid.pattern.circuits, 6);
    EXPECT_EQ(laid.interlacing.crossings, crossings_of(p.plan));
    // Bands of either hand cover a share c each, and cross where both do.
    const double share = 6.0 * kTow.width_mm / (2.0 * kPi * 40.0 * std::cos(options.angle_rad));
    EXPECT_NEAR(p.plan.coverage.fraction, 1.0 - (1.0 - share) * (1.0 - share), 0.01);
}

TEST(PatternPlan, SeriesLieBesideOneAnotherAndPliesOnEachOther) {
    PatternOptions options{.angle_rad = rad_from_deg(50.0), .tow = kTow};
    options.lattice = LatticeConstraints{.circuits = 5, .series = 2, .plies = 2};
    const Planned p = planned(test::made_cylinder(40.0, 200.0, 5.0), options);
    expect_one_fibre(p.plan);
    const std::vector<PassAround> passes = passes_of(p.plan);
    ASSERT_EQ(passes.size(), 40U);
    EXPECT_LT(p.plan.pattern()->closure_rad, kClosure_rad);
    const double band_rad = kTow.width_mm / (40.0 * std::cos(options.angle_rad));
    for (std::size_t i = 0; i < 20; ++i) {
        EXPECT_NEAR(std::remainder(passes[i + 20].begin_rad - passes[i].begin_rad, 2.0 * kPi), 0.0,
                    kClosure_rad);
        if (i < 10) {
            EXPECT_NEAR(std::remainder(passes[i + 10].begin_rad - passes[i].begin_rad, 2.0 * kPi),
                        band_rad, kClosure_rad);
        }
    }
    EXPECT_NEAR(p.plan.pattern()->lattice->rib_mm, 12.0, 1e-12);
}

TEST(PatternPlan, LatticesOnAVesselHaveNoSeries) {
    PatternOptions options{.angle_rad = rad_from_deg(40.0), .tow = kTow};
    options.lattice = LatticeConstraints{.circuits = 9};
    const Mandrel vessel = test::made("vessel", kVessel, 5.0);
    const Planned one = planned(vessel, options);
    expect_one_fibre(one.plan);
    expect_closed(one.plan);
    EXPECT_EQ(one.plan.pattern()->interlacing.crossings, crossings_of(one.plan));
    options.lattice->series = 2;
    const Planned two = planned(vessel, options);
    EXPECT_NE(two.plan.failure, "");
    EXPECT_TRUE(two.plan.pieces.empty());
}

TEST(PatternPlan, WishesReachTheFibre) {
    PatternOptions options{.angle_rad = rad_from_deg(50.0), .tow = kTow};
    options.wish = {.circuits = 30,
                    .starts = 7,
                    .order = BandOrder::Lagging,
                    .least_dwell_rad = rad_from_deg(20.0)};
    const Planned p = planned(test::made_cylinder(40.0, 200.0, 5.0), options);
    expect_one_fibre(p.plan);
    expect_closed(p.plan);
    EXPECT_EQ(p.plan.courses, 60);
    EXPECT_EQ(p.plan.pattern()->interlacing.crossings, crossings_of(p.plan));
    // After 7 circuits a band lies beside the first, behind it.
    const std::vector<PassAround> passes = passes_of(p.plan);
    EXPECT_NEAR(std::remainder(passes[14].begin_rad - passes[0].begin_rad, 2.0 * kPi),
                -2.0 * kPi / 30.0, kClosure_rad);
    // All turns but the last, of which the lower rim has one less.
    EXPECT_GE(p.plan.turns[0].dwell_rad + p.plan.turns[1].dwell_rad,
              59.0 * rad_from_deg(20.0) - 1e-6);
    options.wish.starts = 6;
    // The one above is near.
    EXPECT_TRUE(test::tells(planned(test::made_cylinder(40.0, 200.0, 5.0), options).plan.failure,
                            "30 circuits, 7 starts"));
}

TEST(PatternPlan, HoopsCoverTheCylinderAlone) {
    const Planned p = planned(test::made("vessel", kVessel, 5.0),
                              {.kind = PatternKind::Hoop, .layers = 2.0, .tow = kTow});
    expect_one_fibre(p.plan);
    EXPECT_EQ(p.plan.courses, 2);
    EXPECT_NEAR(p.plan.coverage.fraction, p.plan.coverage.reachable, 2e-3);
    for (const Piece& piece : p.plan.pieces) {
        for (const PathPoint& at : piece.path) {
            EXPECT_LE(std::abs(at.position_mm.z()), 40.0 - 0.5 * kTow.width_mm + kOnWall_mm);
        }
    }
}

TEST(PatternPlan, IsNotLaidWhereItTurnsBackTooSoonToCover) {
    const Mandrel vessel = test::made("vessel", kVessel, 5.0);
    for (const double angle_deg : {45.0, 60.0, 75.0}) {
        SCOPED_TRACE(angle_deg);
        const double angle_rad = rad_from_deg(angle_deg);
        const Plan free = planned(vessel, {.angle_rad = angle_rad, .tow = kTow}).plan;
        ASSERT_EQ(free.failure, "");
        const double covered = free.coverage.fraction;
        const auto asked = [&](double least) {
            return planned(vessel, {.angle_rad = angle_rad, .tow = kTow, .least_covered = least})
                .plan;
        };
        EXPECT_EQ(asked(covered - 0.01).pieces.size(), free.pieces.size());
        const Plan refused = asked(covered + 0.02);
        EXPECT_NE(refused.failure, "");
        EXPECT_TRUE(refused.pieces.empty());
    }
}

TEST(PatternPlan, SaysWhyNothingCanBeWound) {
    const Planned steep = planned(test::made_cylinder(40.0, 200.0, 5.0),
                                  {.angle_rad = rad_from_deg(20.0), .tow = kTow});
    // R / slip (1 / sin(20 deg) - 1) with the slip of turns, 0.98 of the friction, and half a tow.
    const double needed_mm =
        turn_run_mm(40.0, rad_from_deg(20.0), kTow.friction.share(0.98)) + 0.5 * kTow.width_mm;
    EXPECT_TRUE(test::tells(steep.plan.failure, fixed(needed_mm, 1) + " mm")) << steep.plan.failure;
    EXPECT_TRUE(test::tells(steep.plan.failure, "150.0")) << steep.plan.failure;
    EXPECT_TRUE(steep.plan.pieces.empty());
    const Planned open =
        planned(test::made_cylinder(40.0, 200.0, 5.0), {.kind = PatternKind::Polar, .tow = kTow});
    EXPECT_NE(open.plan.failure, "");
    EXPECT_TRUE(open.plan.pieces.empty());
    const Planned round =
        planned(test::made("ellipsoid", {{"equator-radius", 50.0}, {"pole-radius", 40.0}}, 5.0),
                {.kind = PatternKind::Hoop, .tow = kTow});
    EXPECT_NE(round.plan.failure, "");
    EXPECT_TRUE(round.plan.pieces.empty());
}

TEST(PatternPlan, SameForAnyNumberOfThreads) {
    const Mandrel mandrel = test::made_cylinder(30.0, 120.0, 5.0);
    const RevolutionFinding found = find_revolution(mandrel);
    ASSERT_TRUE(found.body.has_value());
    PatternOptions options;
    options.tow = kTow;
    options.turn.extension_mm = 150.0;
    set_thread_count(1);
    const Plan one = plan_pattern(mandrel, *found.body, options);
    set_thread_count(2);
    const Plan two = plan_pattern(mandrel, *found.body, options);
    set_thread_count(0);
    ASSERT_EQ(one.pieces.size(), two.pieces.size());
    for (std::size_t i = 0; i < one.pieces.size(); ++i) {
        ASSERT_EQ(one.pieces[i].path.size(), two.pieces[i].path.size());
        EXPECT_EQ(one.pieces[i].path.back().position_mm, two.pieces[i].path.back().position_mm);
        EXPECT_EQ(one.pieces[i].slip, two.pieces[i].slip);
    }
}

}  // namespace
}  // namespace meshwind
