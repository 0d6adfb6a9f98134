#include "geodesic/biarc.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/frozen.h"
#include "tests/support/reference.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 50.0;

Surface cylinder() {
    return test::frozen(make_mandrel("cylinder", {{"radius", kRadius_mm}, {"length", 300.0}},
                                     {.edge_mm = 5.0, .irregular = true}));
}

// A place on the cylinder and the direction at `beta` from its axis.
PathPoint place(const Surface& surface, double azimuth_rad, double z_mm, double beta_rad) {
    PathPoint point;
    point.normal = {std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0};
    point.position_mm = kRadius_mm * point.normal + z_mm * Vector3d::UnitZ();
    point.at = test::patch_point(surface, point.position_mm);
    point.tangent = std::sin(beta_rad) * Vector3d::UnitZ().cross(point.normal) +
                    std::cos(beta_rad) * Vector3d::UnitZ();
    return point;
}

// On a cylinder of radius R a slip ratio m turns beta by dbeta/ds = -m sin(beta)^2 / R (to the left
// of travel is towards the axis): 1/sin(beta)^2 integrates to cot(beta) = cot(beta0) + m s / R, and
// with it z and azimuth in closed form.
struct Helix {
    double azimuth_rad, z_mm, cot;

    [[nodiscard]] Helix after(double slip, double length_mm) const {
        if (slip == 0.0) {
            const double root = std::sqrt(1.0 + cot * cot);
            return {azimuth_rad + length_mm / root / kRadius_mm, z_mm + length_mm * cot / root,
                    cot};
        }
        const double end = cot + slip * length_mm / kRadius_mm;
        return {azimuth_rad + (std::asinh(end) - std::asinh(cot)) / slip,
                z_mm + kRadius_mm / slip * (std::hypot(1.0, end) - std::hypot(1.0, cot)), end};
    }
    [[nodiscard]] PathPoint on(const Surface& surface) const {
        return place(surface, azimuth_rad, z_mm, std::atan2(1.0, cot));
    }
};

TEST(Biarc, FindsTheTwoSlipRatiosOfAClosedForm) {
    const Surface surface = cylinder();
    for (const auto& [first, second] : {std::pair{0.1, -0.15}, std::pair{-0.2, 0.05},
                                        std::pair{0.0, 0.0}, std::pair{0.18, 0.18}}) {
        const Helix start{0.3, -60.0, 1.0 / std::tan(rad_from_deg(60.0))};
        const Helix end = start.after(first, 45.0).after(second, 45.0);
        const Biarc found = biarc(surface, start.on(surface), end.on(surface));
        ASSERT_TRUE(found.found) << first << ' ' << second << ' ' << found.miss_mm;
        EXPECT_NEAR(found.slip_ratio, first, 1e-3);
        EXPECT_NEAR(found.slip_ratio_2, second, 1e-3);
        EXPECT_NEAR(found.path.back().s_mm, 90.0, 1e-2);
        // One path, along the wall, from the one place and direction to the other.
        EXPECT_LT((found.path.front().position_mm - start.on(surface).position_mm).norm(), 2e-3);
        EXPECT_LT((found.path.back().position_mm - end.on(surface).position_mm).norm(), 2e-3);
        EXPECT_LT((found.path.back().tangent - end.on(surface).tangent).norm(), 1e-3);
        for (std::size_t i = 1; i < found.path.size(); ++i) {
            const double way = (found.path[i].position_mm - found.path[i - 1].position_mm).norm();
            ASSERT_NEAR(found.path[i].s_mm - found.path[i - 1].s_mm, way, 1e-2 * way + 1e-6);
            ASSERT_NEAR(found.path[i].position_mm.head<2>().norm(), kRadius_mm, 5e-3);
        }
    }
}

TEST(Biarc, AsksForMoreSlipTheShorterTheWay) {
    const Surface surface = cylinder();
    const PathPoint from = place(surface, 0.0, 0.0, rad_from_deg(70.0));
    double before = 0.0;
    for (const double turn : {1.2, 0.8, 0.4}) {
        const Biarc found = biarc(surface, from, place(surface, turn, 4.0, rad_from_deg(70.0)));
        ASSERT_TRUE(found.found) << turn;
        const double slip = std::max(std::abs(found.slip_ratio), std::abs(found.slip_ratio_2));
        EXPECT_GT(slip, before);
        before = slip;
    }
    EXPECT_GT(before, 0.2);
}

TEST(Biarc, SaysWhereNoneIsFound) {
    const Surface surface = cylinder();
    const PathPoint from = place(surface, 0.0, 0.0, rad_from_deg(80.0));
    // The next place lies behind: on a cylinder no fibre turns back within a few mm.
    EXPECT_FALSE(biarc(surface, from, place(surface, -0.05, 0.0, rad_from_deg(80.0))).found);
    EXPECT_FALSE(biarc(surface, from, from).found);
}

}  // namespace
}  // namespace meshwind
