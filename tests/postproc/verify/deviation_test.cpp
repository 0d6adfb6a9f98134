#include "postproc/verify/deviation.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 50.0;

// A place and a direction on the unrolled cylinder.
struct Flat {
    double x_mm, y_mm, heading_rad;
};

PathPoint rolled(const Flat& flat) {
    const double azimuth = flat.x_mm / kRadius_mm;
    PathPoint p;
    p.normal = {std::cos(azimuth), std::sin(azimuth), 0.0};
    p.position_mm = kRadius_mm * p.normal + flat.y_mm * Vector3d::UnitZ();
    p.tangent = std::cos(flat.heading_rad) * Vector3d::UnitZ().cross(p.normal) +
                std::sin(flat.heading_rad) * Vector3d::UnitZ();
    return p;
}

// n stations `step_mm` apart.
std::vector<Flat> straight(double heading_rad, double step_mm, int n) {
    std::vector<Flat> line;
    line.reserve(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
        line.push_back({i * step_mm * std::cos(heading_rad), i * step_mm * std::sin(heading_rad),
                        heading_rad});
    }
    return line;
}

// 60 mm up, round a half circle of 5 mm, and 60 mm down again, `aside_mm` to the left of that.
std::vector<Flat> there_and_back(double step_mm, double aside_mm = 0.0) {
    std::vector<Flat> line;
    const double radius = 5.0 - aside_mm;
    for (double s = 0.0; s < 60.0; s += step_mm) {
        line.push_back({-radius, s, 0.5 * kPi});
    }
    const int turns = static_cast<int>(5.0 * kPi / step_mm);
    for (int i = 0; i <= turns; ++i) {
        const double angle = kPi - kPi * i / turns;
        line.push_back(
            {radius * std::cos(angle), 60.0 + radius * std::sin(angle), angle - 0.5 * kPi});
    }
    for (double s = step_mm; s <= 60.0; s += step_mm) {
        line.push_back({radius, 60.0 - s, -0.5 * kPi});
    }
    return line;
}

LaidPath laid(const std::vector<Flat>& line) {
    LaidPath result;
    for (const Flat& flat : line) {
        PathPoint station = rolled(flat);
        if (!result.path.empty()) {
            const PathPoint& before = result.path.back();
            station.s_mm = before.s_mm + (station.position_mm - before.position_mm).norm();
        }
        result.path.push_back(station);
        result.at.emplace_back();
    }
    return result;
}

PlannedFibre planned(const std::vector<Flat>& line) {
    PlannedFibre fibre;
    for (const Flat& flat : line) {
        const PathPoint p = rolled(flat);
        fibre.push_back({0, static_cast<std::int32_t>(fibre.size()), p.position_mm, p.normal,
                         p.tangent, false});
    }
    return fibre;
}

constexpr double kHeading_rad = rad_from_deg(40.0);
constexpr LaydownTolerance kTolerance{.deviation_mm = 0.2, .angle_rad = 0.005};

// Cubics between stations d apart on a curve of curvature k: their middle is off by its torsion
// terms, of order k^2 d^3 / 100, 2e-4 mm for 4 mm on 50 mm.
constexpr double kCubic_mm = 3e-4;
constexpr double kCubic_rad = 3e-4;

TEST(Compare, SameFibreAtOtherStationsDoesNotDeviate) {
    const Deviation off = compare(laid(straight(kHeading_rad, 1.27, 79)),
                                  planned(straight(kHeading_rad, 4.0, 26)), kTolerance);
    EXPECT_LT(off.max_mm, kCubic_mm);
    EXPECT_LT(off.max_angle_rad, kCubic_rad);
    EXPECT_TRUE(off.wrong.empty());
    EXPECT_NEAR(off.end_gap_mm, 25 * 4.0 - 78 * 1.27, 1e-3);
    ASSERT_EQ(off.planned.size(), 79U);
    for (std::size_t i = 0; i < 79; ++i) {
        EXPECT_EQ(off.planned[i], static_cast<std::size_t>(1.27 * static_cast<double>(i) / 4.0));
    }
}

TEST(Compare, MeasuresAShiftAcrossTheFibreAlone) {
    const PlannedFibre plan = planned(straight(kHeading_rad, 4.0, 26));
    const auto shifted = [&](double along_mm, double across_mm) {
        std::vector<Flat> line = straight(kHeading_rad, 1.3, 70);
        for (Flat& flat : line) {
            flat.x_mm += along_mm * std::cos(kHeading_rad) - across_mm * std::sin(kHeading_rad);
            flat.y_mm += along_mm * std::sin(kHeading_rad) + across_mm * std::cos(kHeading_rad);
        }
        return compare(laid(line), plan, kTolerance);
    };
    for (const double across_mm : {-0.15, 0.15}) {
        const Deviation within = shifted(0.0, across_mm);
        EXPECT_NEAR(within.max_mm, 0.15, kCubic_mm);
        EXPECT_TRUE(within.wrong.empty());
    }
    const Deviation beyond = shifted(0.0, 0.25);
    EXPECT_NEAR(beyond.max_mm, 0.25, kCubic_mm);
    EXPECT_EQ(beyond.wrong.size(), 70U);
    EXPECT_EQ(beyond.wrong.front(), 0U);
    const Deviation along = shifted(1.0, 0.0);
    EXPECT_LT(along.max_mm, kCubic_mm);
    EXPECT_TRUE(along.wrong.empty());
}

TEST(Compare, MeasuresATurnAsAngleAndAsGrowingDistance) {
    const double turn = 0.01;
    std::vector<Flat> line = straight(kHeading_rad + turn, 1.0, 61);
    const Deviation off = compare(laid(line), planned(straight(kHeading_rad, 4.0, 26)), kTolerance);
    EXPECT_NEAR(off.max_angle_rad, turn, kCubic_rad);
    EXPECT_NEAR(off.max_mm, 60.0 * std::sin(turn), kCubic_mm);
    EXPECT_EQ(off.max_at, 60U);
    EXPECT_EQ(off.wrong.size(), 61U);
    // Of the distance alone, those after 0.2 mm / 0.01.
    const Deviation wide = compare(laid(line), planned(straight(kHeading_rad, 4.0, 26)),
                                   {.deviation_mm = 0.2, .angle_rad = 0.02});
    ASSERT_FALSE(wide.wrong.empty());
    EXPECT_NEAR(static_cast<double>(wide.wrong.front()), 20.0, 1.0);
    EXPECT_EQ(wide.wrong.back(), 60U);
}

TEST(Compare, SaysHowFarTheEndIsFromThePlansEnd) {
    const Deviation off = compare(laid(straight(kHeading_rad, 1.0, 98)),
                                  planned(straight(kHeading_rad, 4.0, 26)), kTolerance);
    // 3 mm of helix, straight to 1e-3 of itself.
    EXPECT_NEAR(off.end_gap_mm, 3.0, 3e-3);
    EXPECT_TRUE(off.wrong.empty());
}

TEST(Compare, LeavesOutWhatIsInTheAir) {
    const PlannedFibre plan = planned(straight(kHeading_rad, 4.0, 26));
    std::vector<Flat> line = straight(kHeading_rad, 1.0, 98);
    for (std::size_t i = 41; i < 47; ++i) {
        line[i].y_mm += 1.0;
    }
    LaidPath path = laid(line);
    EXPECT_EQ(compare(path, plan, kTolerance).wrong.size(), 6U);
    for (std::size_t i = 41; i < 47; ++i) {
        path.at[i].lifted = true;
    }
    EXPECT_TRUE(compare(path, plan, kTolerance).wrong.empty());
    // The same where the plan is in the air: between 40 and 48 mm.
    LaidPath grounded = laid(line);
    PlannedFibre bridge = plan;
    bridge[11].lifted = true;
    EXPECT_TRUE(compare(grounded, bridge, kTolerance).wrong.empty());
    bridge[11].lifted = false;
    bridge[15].lifted = true;
    EXPECT_EQ(compare(grounded, bridge, kTolerance).wrong.size(), 6U);
}

// At a joint the end of one piece and the start of the next are one place.
TEST(Compare, GoesOnAcrossPieces) {
    const PlannedFibre line = planned(straight(kHeading_rad, 4.0, 26));
    PlannedFibre plan;
    for (std::size_t i = 0; i < line.size(); ++i) {
        plan.push_back(line[i]);
        if (i % 8 == 7) {
            plan.push_back(line[i]);
            plan.back().piece = plan[plan.size() - 2].piece + 1;
        }
    }
    const LaidPath path = laid(straight(kHeading_rad, 1.0, 98));
    const Deviation off = compare(path, plan, kTolerance);
    EXPECT_LT(off.max_mm, kCubic_mm);
    EXPECT_LT(off.max_angle_rad, kCubic_rad);
    EXPECT_EQ(off.planned.back(), 24U + 3U);
}

// Two pieces that meet at an angle: of the two stations there the first ends one and the second
// leads on.
TEST(Compare, TakesTheKinkOfAJointAsPlanned) {
    const auto kinked = [](double step_mm, int n) {
        std::vector<Flat> line = straight(kHeading_rad, step_mm, n + 1);
        const Flat joint = line.back();
        for (const Flat& flat : straight(kHeading_rad + 0.5, step_mm, n + 1)) {
            line.push_back({joint.x_mm + flat.x_mm, joint.y_mm + flat.y_mm, flat.heading_rad});
        }
        return line;
    };
    const Deviation off = compare(laid(kinked(1.25, 32)), planned(kinked(4.0, 10)), kTolerance);
    EXPECT_LT(off.max_mm, kCubic_mm);
    EXPECT_TRUE(off.wrong.empty());
    const LaidPath turned = laid(kinked(1.25, 32));
    const Deviation without = compare(turned, planned(straight(kHeading_rad, 4.0, 21)), kTolerance);
    EXPECT_GE(without.wrong.size(), 30U);
}

// Over an edge the direction swings on the spot, and nowhere else.
TEST(Compare, AnyDirectionOnTheSpotOfAKinkAlone) {
    std::vector<Flat> plan = straight(kHeading_rad, 4.0, 11);
    const Flat edge = plan.back();
    for (Flat flat : straight(kHeading_rad + 0.5, 4.0, 11)) {
        flat.x_mm += edge.x_mm;
        flat.y_mm += edge.y_mm;
        plan.push_back(flat);
    }
    const auto wrong = [&](double before_mm) {
        const std::vector<Flat> line = {
            plan.front(),
            {edge.x_mm - before_mm * std::cos(kHeading_rad),
             edge.y_mm - before_mm * std::sin(kHeading_rad), kHeading_rad + 0.25},
            plan.back()};
        return compare(laid(line), planned(plan), kTolerance).wrong;
    };
    EXPECT_TRUE(wrong(0.9 * kTolerance.deviation_mm).empty());
    EXPECT_EQ(wrong(1.1 * kTolerance.deviation_mm), (std::vector<std::size_t>{1}));
}

// Tied on at a rim, and cut there, the fibre has a station on the extension's side of the edge.
TEST(Compare, BeginsAndEndsOnEitherSideOfARimsEdge) {
    const std::vector<Flat> plan = straight(kHeading_rad, 4.0, 26);
    const auto turned = [](Flat flat) {
        flat.heading_rad += 0.1;
        return flat;
    };
    std::vector<Flat> line = plan;
    line.insert(line.begin(), turned(line.front()));
    line.push_back(turned(line.back()));
    EXPECT_TRUE(compare(laid(line), planned(plan), kTolerance).wrong.empty());
    // Anywhere else a turned station is wrong.
    line.insert(line.begin() + 9, turned(line[8]));
    EXPECT_EQ(compare(laid(line), planned(plan), kTolerance).wrong, (std::vector<std::size_t>{9}));
}

// Both ways are 10 mm apart: each laid station belongs to its own.
TEST(Compare, KeepsTheTwoWaysOfAPathThatDoublesBackApart) {
    const PlannedFibre plan = planned(there_and_back(2.0));
    const Deviation same = compare(laid(there_and_back(0.7)), plan, kTolerance);
    // Half circles of 5 mm in cubics of 2 mm: (2 / 5)^6 / 4000 of 5 mm and less.
    EXPECT_LT(same.max_mm, 5e-3);
    EXPECT_TRUE(same.wrong.empty());
    for (std::size_t i = 1; i < same.planned.size(); ++i) {
        ASSERT_GE(same.planned[i], same.planned[i - 1]);
    }
    EXPECT_GT(same.planned.back() + 3, plan.size());
    const Deviation aside = compare(laid(there_and_back(0.7, 0.3)), plan, kTolerance);
    EXPECT_NEAR(aside.max_mm, 0.3, 5e-3);
    EXPECT_EQ(aside.wrong.size(), aside.planned.size());
}

TEST(Compare, AFibreThatLeavesThePlanDoesNotRunAheadOnIt) {
    const Deviation off = compare(laid(straight(kHeading_rad + 0.5 * kPi, 4.0, 50)),
                                  planned(straight(kHeading_rad, 4.0, 26)), kTolerance);
    EXPECT_GT(off.max_mm, 30.0);
    EXPECT_LE(off.planned.back(), 1U);
    EXPECT_EQ(off.wrong.size(), 50U);
}

TEST(PlannedFibre, HasAllStationsInWindingOrder) {
    std::vector<Piece> pieces(2);
    for (Piece& piece : pieces) {
        for (const Flat& flat : straight(kHeading_rad, 4.0, 3)) {
            piece.path.push_back(rolled(flat));
            piece.string.gap_mm.push_back(0.0);
        }
    }
    pieces[1].string.gap_mm[1] = 0.3;
    const PlannedFibre fibre = planned_fibre(pieces);
    ASSERT_EQ(fibre.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(fibre[i].piece, static_cast<std::int32_t>(i / 3));
        EXPECT_EQ(fibre[i].point, static_cast<std::int32_t>(i % 3));
        EXPECT_EQ(fibre[i].position_mm, pieces[0].path[i % 3].position_mm);
        EXPECT_EQ(fibre[i].tangent, pieces[0].path[i % 3].tangent);
        EXPECT_EQ(fibre[i].lifted, i == 4);
    }
}

// By 0.8 deg over `way_mm` from the middle on, where 0.3 deg and 0.2 mm are allowed.
Deviation swung(double way_mm) {
    const std::vector<Flat> line = straight(0.7, 2.0, 31);
    std::vector<Flat> off = straight(0.7, 0.1, 601);
    for (Flat& flat : off) {
        const double s_mm = std::hypot(flat.x_mm, flat.y_mm);
        if (s_mm > 30.05 && s_mm < 30.05 + way_mm) {
            flat.heading_rad += rad_from_deg(0.8);
        }
    }
    return compare(laid(off), planned(line), {.deviation_mm = 0.2, .angle_rad = rad_from_deg(0.3)});
}

TEST(Compare, AnAngleCountsWhereItLeadsAside) {
    // Between the stations on either side it leads 0.007 mm aside, then 0.015 mm; a twentieth of
    // 0.2 mm is 0.01.
    const Deviation shortly = swung(0.4);
    EXPECT_TRUE(shortly.wrong.empty());
    EXPECT_LT(shortly.max_angle_rad, rad_from_deg(0.01));
    const Deviation long_enough = swung(1.0);
    EXPECT_EQ(long_enough.wrong.size(), 10U);
    EXPECT_NEAR(long_enough.max_angle_rad, rad_from_deg(0.8), 1e-6);
}

}  // namespace
}  // namespace meshwind
