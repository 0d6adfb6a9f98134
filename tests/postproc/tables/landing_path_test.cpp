#include "postproc/tables/landing_path.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/frozen.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 70.0;

const Surface& cylinder() {
    static const Surface kSurface =
        test::frozen(make_mandrel("cylinder", {{"radius", kRadius_mm}, {"length", 400.0}},
                                  {.edge_mm = 6.0, .irregular = true}));
    return kSurface;
}

// A helix of 45 deg from (R, 0, -100).
Vector3d helix(double s_mm, double radius_mm = kRadius_mm) {
    const double c = std::sqrt(0.5);
    const double turn = c * s_mm / kRadius_mm;
    return {radius_mm * std::cos(turn), radius_mm * std::sin(turn), c * s_mm - 100.0};
}
Vector3d helix_tangent(double s_mm) {
    const double c = std::sqrt(0.5);
    const double turn = c * s_mm / kRadius_mm;
    return {-c * std::sin(turn), c * std::cos(turn), c};
}

// Rows at places of the helix, their lines counted from 2 as behind a line of names.
LandingCourse course_at(const std::vector<double>& s_mm, double radius_mm = kRadius_mm) {
    LandingCourse course{"7", false, {}};
    for (const double s : s_mm) {
        course.rows.push_back({static_cast<int>(course.rows.size()) + 2, helix(s, radius_mm), {}});
    }
    return course;
}

std::vector<double> uneven(double h_mm, double length_mm) {
    std::vector<double> s_mm{0.0};
    for (int i = 0; s_mm.back() < length_mm; ++i) {
        s_mm.push_back(s_mm.back() + (i % 2 == 0 ? h_mm : 0.5 * h_mm));
    }
    return s_mm;
}

std::string error_of(const LandingCourse& course, const char* code,
                     const LandingOptions& options = {.file = "points.csv"}) {
    LandingPaths paths(cylinder(), options);
    try {
        (void)paths.through(course);
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), code);
        return error.what();
    }
    ADD_FAILURE() << "accepted";
    return "";
}

// data/reference/seed004.json, irregular_spacing: 0.00097 deg for distances of 2 and 1 mm at
// R = 70, a quarter with half of them.
TEST(ParabolaTangent, IsSecondOrderAtUnevenSpacing) {
    double before = 0.0;
    for (const double h : {2.0, 1.0, 0.5}) {
        const double error = std::acos(std::min(
            1.0, parabola_tangent(helix(-h), helix(0.0), helix(0.5 * h)).dot(helix_tangent(0.0))));
        if (h == 2.0) {
            EXPECT_NEAR(deg_from_rad(error), 0.0009744, 1e-6);
        } else {
            EXPECT_NEAR(before / error, 4.0, 0.1);
        }
        before = error;
    }
}

TEST(ParabolaTangent, IsSecondOrderAtTheEnds) {
    double before = 0.0;
    for (const double h : {8.0, 4.0, 2.0}) {
        const Vector3d tangent = parabola_end_tangent(helix(0.0), helix(h), helix(1.5 * h));
        const double error = (tangent - helix_tangent(0.0)).norm();
        if (before > 0.0) {
            EXPECT_NEAR(before / error, 4.0, 0.3);
        }
        before = error;
    }
    EXPECT_LT(deg_from_rad(before), 0.01);
}

TEST(LandingPath, FollowsAHelixWithItsDirectionsAndLength) {
    for (const double h : {2.0, 16.0}) {
        const std::vector<double> s_mm = uneven(h, 400.0);
        LandingPaths paths(cylinder(), {.file = "points.csv"});
        const SurfacePath path = paths.through(course_at(s_mm));
        EXPECT_EQ(paths.moves().points, s_mm.size());
        EXPECT_EQ(paths.moves().repeated, 0U);
        EXPECT_LT(paths.moves().worst_mm, 1e-3);
        // Cubics through second-order tangents: h^3 / 100 / R^2 of the length.
        EXPECT_NEAR(path.back().s_mm, s_mm.back(), 2e-4 * s_mm.back());
        for (std::size_t i = 0; i < path.size(); ++i) {
            const PathPoint& p = path[i];
            const double s = (p.position_mm.z() + 100.0) / std::sqrt(0.5);
            ASSERT_LT((p.position_mm - helix(s)).norm(), 0.02);
            // At the ends the parabola is off by 3 h^2 / 16 of the curve's third derivative.
            ASSERT_LT(deg_from_rad((p.tangent - helix_tangent(s)).norm()), 0.0016 * h * h + 0.005);
            ASSERT_NEAR(p.kn_per_mm, 0.5 / kRadius_mm, 2e-4);
            ASSERT_NEAR(p.tangent.dot(p.normal), 0.0, 1e-9);
            ASSERT_TRUE(i == 0 || p.s_mm - path[i - 1].s_mm < 2.0 * kLandingStation_mm);
        }
        EXPECT_EQ(path.front().s_mm, 0.0);
    }
}

TEST(LandingPath, LaysPointsOnTheWallAndTellsHowFarTheyWere) {
    LandingCourse course = course_at(uneven(5.0, 100.0), kRadius_mm + 0.3);
    course.rows[4].position = helix(
        course.rows[4].position.z() / std::sqrt(0.5) + 100.0 * std::sqrt(2.0), kRadius_mm - 0.7);
    LandingPaths paths(cylinder(), {.file = "points.csv"});
    const SurfacePath path = paths.through(course);
    EXPECT_NEAR(paths.moves().worst_mm, 0.7, 1e-3);
    EXPECT_EQ(paths.moves().worst_line, 6);
    EXPECT_NEAR(paths.moves().sum_mm, 0.3 * static_cast<double>(course.rows.size() - 1) + 0.7,
                1e-2);
    for (const PathPoint& p : path) {
        ASSERT_NEAR(p.position_mm.head<2>().norm(), kRadius_mm, 2e-3);
    }
}

TEST(LandingPath, TakesRepeatedRowsOnce) {
    const std::vector<double> s_mm{0.0, 0.0, 5.0, 10.0, 10.00005, 15.0, 15.0};
    LandingPaths paths(cylinder(), {.file = "points.csv"});
    const SurfacePath path = paths.through(course_at(s_mm));
    EXPECT_EQ(paths.moves().repeated, 3U);
    EXPECT_NEAR(path.back().s_mm, 15.0, 1e-2);
    for (const PathPoint& p : path) {
        const double s = (p.position_mm.z() + 100.0) / std::sqrt(0.5);
        ASSERT_LT((p.tangent - helix_tangent(s)).norm(), 2e-3);
    }
}

// Over a sharp edge the fibre has two directions; rows that name both normals keep them apart.
TEST(LandingPath, KeepsTheTwoSidesOfASharpEdge) {
    // A roof of 90 deg over the y axis, made of squares.
    TriangleSoup roof;
    const double c = std::sqrt(0.5);
    const auto point = [&](int i, int j) -> Vector3d {
        return {c * 10.0 * i, 10.0 * j, -c * 10.0 * std::abs(i)};
    };
    for (int i = -6; i <= 6; ++i) {
        for (int j = -6; j <= 6; ++j) {
            roof.points_mm.push_back(point(i, j));
        }
    }
    for (int i = 0; i < 12; ++i) {
        for (int j = 0; j < 12; ++j) {
            const int a = 13 * i + j;
            roof.faces.push_back({a, a + 13, a + 14});
            roof.faces.push_back({a, a + 14, a + 1});
        }
    }
    const Surface surface = test::frozen(roof);
    const Vector3d left(-c, 0.0, c);
    const Vector3d right(c, 0.0, c);
    LandingCourse course{"1", false, {}};
    for (int k = -5; k <= 5; ++k) {
        const double s = 4.0 * k;  // at 45 deg to the edge once it is rolled flat
        const Vector3d p(0.5 * s, c * s, -0.5 * std::abs(s));
        const int line = static_cast<int>(course.rows.size()) + 2;
        if (k <= 0) {
            course.rows.push_back({line, p, left});
        }
        if (k >= 0) {
            course.rows.push_back({line, p, right});
        }
    }
    LandingPaths paths(surface, {.file = "points.csv"});
    const SurfacePath path = paths.through(course);
    EXPECT_EQ(paths.moves().repeated, 0U);
    ASSERT_EQ(path.size(), 12U);
    EXPECT_NEAR(path.back().s_mm, 40.0, 1e-6);
    for (const PathPoint& p : path) {
        const bool before = p.tangent.z() > 0.0;
        EXPECT_LT((p.tangent - Vector3d(0.5, c, before ? 0.5 : -0.5)).norm(), 1e-6);
        EXPECT_LT((p.normal - (before ? left : right)).norm(), 1e-6);
    }
    EXPECT_EQ(path[5].s_mm, path[6].s_mm);
    EXPECT_GT(path[5].tangent.z(), 0.0);
    EXPECT_LT(path[6].tangent.z(), 0.0);
}

// 16 mm apart the parabola is off by half a degree at the ends, the curve's own directions by none.
TEST(LandingPath, TakesDirectionsThatAreGiven) {
    LandingCourse course = course_at(uneven(16.0, 200.0));
    const std::vector<double> s_mm = uneven(16.0, 200.0);
    for (std::size_t i = 0; i < s_mm.size(); ++i) {
        course.rows[i].tangent = 3.0 * helix_tangent(s_mm[i]);
    }
    LandingPaths paths(cylinder(), {.file = "points.csv"});
    for (const PathPoint& p : paths.through(course)) {
        const double s = (p.position_mm.z() + 100.0) / std::sqrt(0.5);
        ASSERT_LT(deg_from_rad((p.tangent - helix_tangent(s)).norm()), 1e-3);
    }
    course.rows[3].tangent = -helix_tangent(s_mm[3]);
    EXPECT_EQ(error_of(course, "import.tangent").find("points.csv:5: "), 0U);
}

// Through the waist of a ring, rows uneven: the string over a hollow of radius r is lifted by the
// sagitta of its chord, a (c - a) / (2 r) at the arc a of c, wherever the rows are.
TEST(LandingPath, FindsTheStringOverAHollow) {
    constexpr double kRing_mm = 150.0;
    constexpr double kTube_mm = 60.0;
    const Surface surface = test::frozen(make_mandrel(
        "torus", {{"ring-radius", kRing_mm}, {"tube-radius", kTube_mm}}, {.edge_mm = 5.0}));
    LandingCourse course{"1", false, {}};
    std::vector<double> s_mm;
    const double inner_mm = kRing_mm - kTube_mm;
    for (double s = 0.0; s < 30.0; s += s_mm.size() % 2 == 0 ? 7.0 : 4.5) {
        s_mm.push_back(s);
        const double turn = s / inner_mm;
        course.rows.push_back({static_cast<int>(s_mm.size()) + 1,
                               {inner_mm * std::cos(turn), inner_mm * std::sin(turn), 0.0},
                               {}});
    }
    LandingPaths paths(surface, {.file = "points.csv"});
    const SurfacePath path = paths.through(course);
    const TautString string = paths.string_over(path);
    ASSERT_EQ(path.size(), s_mm.size());
    ASSERT_EQ(string.gap_mm.size(), path.size());
    const double chord = s_mm.back();
    for (std::size_t i = 0; i < path.size(); ++i) {
        const double sagitta = s_mm[i] * (chord - s_mm[i]) / (2.0 * inner_mm);
        EXPECT_NEAR(string.gap_mm[i], sagitta, 0.02 * sagitta + 1e-9) << i;
    }
    EXPECT_NEAR(string.worst_gap_mm, chord * chord / (8.0 * inner_mm), 0.02);
}

TEST(LandingPath, ReadsTheFrameAndUnitsOfTheTable) {
    LandingOptions options{.file = "points.csv"};
    options.mandrel_from_table = Eigen::Translation3d(0.0, 0.0, 10.0) *
                                 Eigen::AngleAxisd(0.5 * kPi, Vector3d::UnitX()) *
                                 Eigen::Scaling(25.4);
    LandingCourse course = course_at(uneven(5.0, 50.0));
    for (LandingRow& row : course.rows) {
        row.position = options.mandrel_from_table.inverse() * row.position;
    }
    LandingPaths paths(cylinder(), options);
    EXPECT_LT((paths.through(course).front().position_mm - helix(0.0)).norm(), 1e-3);
}

TEST(LandingPath, RefusesWhatIsNoPathOnThisWall) {
    const std::string off =
        error_of(course_at({0.0, 5.0, 10.0}, kRadius_mm + 2.5), "import.too_far");
    EXPECT_EQ(off.find("points.csv:2: "), 0U) << off;
    EXPECT_TRUE(test::tells(off, "2.500 mm") && test::tells(off, "1.000 mm")) << off;
    LandingCourse far = course_at({0.0, 5.0, 10.0});
    far.rows[1].position.x() = 1e12;
    EXPECT_EQ(error_of(far, "import.too_far").find("points.csv:3: "), 0U);
    LandingCourse hoop = course_at({0.0, 5.0, 10.0});
    for (std::size_t i = 0; i < 3; ++i) {
        const double turn = 1.2 * static_cast<double>(i);
        hoop.rows[i].position = {kRadius_mm * std::cos(turn), kRadius_mm * std::sin(turn), 0.0};
    }
    const std::string sparse = error_of(hoop, "import.sparse");
    EXPECT_EQ(sparse.find("points.csv:3: "), 0U) << sparse;
    EXPECT_TRUE(test::tells(sparse, "45.8 deg")) << sparse;        // kMaxLandingTurn_rad
    error_of(course_at({0.0, 10.0, 5.0, 20.0}), "import.sparse");  // out of order
    error_of(course_at({5.0, 5.0, 5.0}), "import.empty");
    LandingCourse turned = course_at({0.0, 5.0, 10.0});
    turned.rows[2].normal = Vector3d(-1.0, 0.0, 0.0);
    EXPECT_EQ(error_of(turned, "import.normal").find("points.csv:4: "), 0U);
}

}  // namespace
}  // namespace meshwind
