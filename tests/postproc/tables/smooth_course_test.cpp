#include "postproc/tables/smooth_course.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/shapes/make_kinds.h"
#include "postproc/tables/landing_circuits.h"
#include "postproc/tables/landing_path.h"
#include "tests/support/frozen.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 70.0;
constexpr double kLength_mm = 300.0;

const Surface& cylinder() {
    static const Surface kSurface =
        test::frozen(make_mandrel("cylinder", {{"radius", kRadius_mm}, {"length", 400.0}},
                                  {.edge_mm = 6.0, .irregular = true}));
    return kSurface;
}

// On a cylinder, unrolled: x around, z along; a circle of geodesic curvature kg, 45 deg at its
// start.
Eigen::Vector2d circle(double s_mm, double kg_per_mm) {
    const double turn = s_mm * kg_per_mm;
    const double chord = std::abs(turn) < 1e-12 ? s_mm : 2.0 * std::sin(0.5 * turn) / kg_per_mm;
    const double angle = 0.25 * kPi + 0.5 * turn;
    return {chord * std::cos(angle), chord * std::sin(angle) - 100.0};
}

Vector3d rolled(const Eigen::Vector2d& at) {
    return {kRadius_mm * std::cos(at.x() / kRadius_mm), kRadius_mm * std::sin(at.x() / kRadius_mm),
            at.y()};
}

// Points some 12 mm apart, each off by up to `scatter_mm` along the spindle; the ends are not.
LandingCourse scattered(double kg_per_mm, double scatter_mm, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> off(-scatter_mm, scatter_mm);
    LandingCourse course{"1", false, {}};
    for (double s = 0.0; s <= kLength_mm; s += 12.0) {
        Eigen::Vector2d at = circle(s, kg_per_mm);
        at.y() += s > 0.0 && s + 12.0 <= kLength_mm ? off(random) : 0.0;
        course.rows.push_back({static_cast<int>(course.rows.size()) + 2, rolled(at)});
    }
    return course;
}

double worst_slip(const SurfacePath& path) {
    return measure_slip(cylinder(), path, taut_string(path),
                        {.friction = 0.3, .method = TraceMethod::Patches})
        .worst;
}

// A helix slips nowhere, and a steered one by kg R / cos^2: whatever the points scatter.
TEST(SmoothCourse, FindsTheGeodesicThatPointsScatterAbout) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE(seed);
        const LandingCourse course = scattered(0.0, 0.15, seed);
        LandingPaths rough(cylinder(), {.file = "p"});
        EXPECT_GT(worst_slip(rough.through(course)), 0.15);
        LandingPaths smooth(cylinder(), {.smooth_mm = 0.3, .file = "p"});
        const SurfacePath path = smooth.through(course);
        EXPECT_LT(worst_slip(path), 0.02);
        EXPECT_LE(smooth.moves().smoothed_mm, 0.31);
        for (std::size_t i = 1; i < path.size(); ++i) {
            EXPECT_LE(path[i].s_mm - path[i - 1].s_mm, 2.0 * kLandingStation_mm);
        }
    }
}

// Constant curvature stays: at the same slip ratio, within a few hundredths.
TEST(SmoothCourse, KeepsWhatIsSteered) {
    const double kg_per_mm = 0.0007;
    const LandingCourse course = scattered(kg_per_mm, 0.1, 3);
    LandingPaths smooth(cylinder(), {.smooth_mm = 0.15, .file = "p"});
    const SurfacePath path = smooth.through(course);
    const std::size_t middle = path.size() / 2;
    const SlipMeasure slip = measure_slip(cylinder(), path, taut_string(path),
                                          {.friction = 0.3, .method = TraceMethod::Patches});
    EXPECT_NEAR(slip.kg_per_mm[middle], kg_per_mm, 0.15 * kg_per_mm);
    EXPECT_LE(smooth.moves().smoothed_mm, 0.155);
}

// The tolerance bounds it: with less of it the fibre is nearer to the points, and less smooth.
TEST(SmoothCourse, StaysWithinItsTolerance) {
    const LandingCourse course = scattered(0.0, 0.5, 7);
    double slip_before = 0.0;
    for (const double tolerance_mm : {1.0, 0.3, 0.1, 0.03}) {
        LandingPaths smooth(cylinder(), {.smooth_mm = tolerance_mm, .file = "p"});
        const double slip = worst_slip(smooth.through(course));
        EXPECT_LE(smooth.moves().smoothed_mm, 1.05 * tolerance_mm);
        EXPECT_GE(slip, slip_before - 0.01);
        slip_before = slip;
    }
    EXPECT_GT(slip_before, 0.3);
}

TEST(LandingCircuits, AreTurnedAboutTheSpindle) {
    LandingTable table{{scattered(0.0, 0.0, 1)}, true};
    Eigen::Affine3d lying = Eigen::Affine3d::Identity();  // the table has X along the spindle
    lying.linear() = Eigen::AngleAxisd(0.5 * kPi, Vector3d::UnitY()).toRotationMatrix();
    lying.translation() = Vector3d(1.0, 2.0, 3.0);
    for (LandingRow& row : table.courses[0].rows) {
        row.position = lying.inverse() * row.position;
        row.normal = Vector3d::UnitX();
    }
    const LandingTable all = repeated(table, 3, rad_from_deg(100.0), lying);
    ASSERT_EQ(all.courses.size(), 3u);
    EXPECT_EQ(all.courses[2].name, "1 of circuit 3");
    const Vector3d first = lying * table.courses[0].rows[4].position;
    const Vector3d third = lying * all.courses[2].rows[4].position;
    EXPECT_NEAR(first.z(), third.z(), 1e-9);
    const double turn = std::atan2(third.y(), third.x()) - std::atan2(first.y(), first.x());
    EXPECT_NEAR(std::remainder(turn - rad_from_deg(200.0), 2.0 * kPi), 0.0, 1e-12);
    EXPECT_NEAR((*all.courses[1].rows[0].normal - Vector3d::UnitX()).norm(), 0.0, 1e-12);
    EXPECT_EQ(joined(all, 0.1, lying).courses.size(), 3u);
    LandingTable meets = table;
    meets.courses.push_back(table.courses[0]);
    std::reverse(meets.courses[1].rows.begin(), meets.courses[1].rows.end());
    const LandingTable one = joined(meets, 0.1, lying);
    ASSERT_EQ(one.courses.size(), 1u);
    EXPECT_EQ(one.courses[0].rows.size(), 2 * table.courses[0].rows.size() - 1);
}

}  // namespace
}  // namespace meshwind
