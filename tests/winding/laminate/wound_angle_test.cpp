#include "winding/laminate/wound_angle.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "geodesic/trace.h"
#include "tests/support/fixtures.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// A geodesic over a cylinder about z, at an angle to its axis, from the middle of its length.
SurfacePath helix(const Surface& surface, double angle_rad) {
    const SurfacePoint start{static_cast<std::int32_t>(surface.face.size() / 2),
                             Vector3d::Constant(1.0 / 3.0)};
    const Vector3d normal = smooth_normal(surface, start);
    const Vector3d around = Vector3d::UnitZ().cross(normal).normalized();
    return trace(surface, start,
                 std::cos(angle_rad) * Vector3d::UnitZ() + std::sin(angle_rad) * around, {},
                 {.max_length_mm = 100.0, .method = TraceMethod::Patches})
        .path;
}

double worst_error_rad(double edge_mm) {
    const Mandrel mandrel = test::made_cylinder(30.0, 160.0, edge_mm);
    double worst = 0.0;
    for (const double deg : {5.0, 30.0, 45.0, 54.7, 80.0, 89.0}) {
        for (const double hand : {1.0, -1.0}) {
            for (const PathPoint& point : helix(mandrel.surface, hand * rad_from_deg(deg))) {
                const auto angle = winding_angle_rad(mandrel.surface, point);
                if (!angle) {
                    return std::numeric_limits<double>::infinity();
                }
                worst = std::max(worst, std::abs(*angle - rad_from_deg(deg)));
            }
        }
    }
    return worst;
}

// On a cylinder a geodesic keeps its angle. The axial direction comes from fitted shape operators.
TEST(WindingAngle, IsThatOfAHelix) {
    const double coarse = worst_error_rad(6.0);
    const double fine = worst_error_rad(3.0);
    std::printf("winding angle: worst error %.2e at h 6, %.2e at h 3, rad\n", coarse, fine);
    EXPECT_LT(fine, rad_from_deg(0.1));
    EXPECT_GT(coarse / fine, 2.0);
}

TEST(WindingAngle, HasNoMeaningWhereTheWallCurvesBothWays) {
    const Mandrel mandrel = test::made(
        "torus", {{"ring-radius", 80.0}, {"tube-radius", 40.0}, {"angle", 0.5 * kPi}}, 8.0);
    // Outside it curves by 1/40 around the tube and by 1/120 along it: a third as much.
    const Surface& surface = mandrel.surface;
    int pipe = 0;
    int not_pipe = 0;
    for (std::int32_t f = 0; static_cast<std::size_t>(f) < surface.face.size(); f += 3) {
        const SurfacePoint at{f, Vector3d::Constant(1.0 / 3.0)};
        PathPoint point;
        point.at = at;
        point.normal = smooth_normal(surface, at);
        point.tangent = point.normal.unitOrthogonal();
        (winding_angle_rad(surface, point) ? pipe : not_pipe) += 1;
        EXPECT_EQ(axial_direction_rad(surface, at).has_value(),
                  winding_angle_rad(surface, point).has_value());
    }
    // With the angle v around the tube the ratio is cos(v) / (2 + cos(v)), under a quarter either
    // way for -0.4 < cos(v) < 2/3; of the wall, whose area goes by 2 + cos(v), that is 0.39.
    const double share = static_cast<double>(pipe) / (pipe + not_pipe);
    EXPECT_NEAR(share, 0.39, 0.05);
}

// Each pipe of a tee has its own axis: fibre around the branch is hoop there.
TEST(WindingAngle, GoesByTheOwnAxisOfRunAndBranch) {
    const Mandrel mandrel = test::small_tee(3.0);
    const Surface& surface = mandrel.surface;
    const auto of_branch =
        std::find_if(mandrel.rims.begin(), mandrel.rims.end(),
                     [](const Rim& rim) { return std::abs(rim.axis.z()) < 0.5; });
    ASSERT_NE(of_branch, mandrel.rims.end());
    int run = 0;
    int branch = 0;
    for (std::int32_t f = 0; static_cast<std::size_t>(f) < surface.face.size(); f += 5) {
        const SurfacePoint at{f, Vector3d::Constant(1.0 / 3.0)};
        const Vector3d p = position_mm(surface, at);
        PathPoint point;
        point.at = at;
        point.normal = smooth_normal(surface, at);
        // Away from blends and rims, where the fits see something else.
        const bool on_branch = p.head<2>().norm() > 60.0 && p.head<2>().norm() < 100.0;
        const bool on_run = std::abs(p.z()) > 50.0 && std::abs(p.z()) < 80.0;
        if (!on_branch && !on_run) {
            continue;
        }
        const Vector3d axis = on_branch ? of_branch->axis : Vector3d(Vector3d::UnitZ());
        const Vector3d along = (axis - point.normal * point.normal.dot(axis)).normalized();
        point.tangent = point.normal.cross(along);
        const auto angle = winding_angle_rad(surface, point);
        ASSERT_TRUE(angle.has_value());
        EXPECT_NEAR(*angle, 0.5 * kPi, 0.03);
        (on_branch ? branch : run) += 1;
    }
    EXPECT_GT(run, 50);
    EXPECT_GT(branch, 50);
}

TEST(AngleKept, WeighsWhatIsOff) {
    const Mandrel mandrel = test::made_cylinder(30.0, 160.0, 4.0);
    const SurfacePath path = helix(mandrel.surface, rad_from_deg(45.0));
    const double length = path.back().s_mm - path.front().s_mm;
    const AngleKept right = angle_kept(mandrel.surface, path, rad_from_deg(45.0));
    EXPECT_NEAR(right.measured_mm, length, 1e-9);
    EXPECT_NEAR(right.off_mm, 0.0, 1e-3 * length);
    EXPECT_NEAR(right.angle_mm / length, rad_from_deg(45.0), 2e-3);
    // Half of ten degrees off counts a quarter; beyond ten all counts.
    EXPECT_NEAR(angle_kept(mandrel.surface, path, rad_from_deg(50.0)).off_mm / length, 0.25, 0.02);
    EXPECT_EQ(angle_kept(mandrel.surface, path, rad_from_deg(60.0)).off_mm, length);
    EXPECT_NEAR(std::sqrt(angle_kept(mandrel.surface, path, 0.0).square_mm / length),
                rad_from_deg(45.0), 2e-3);
}

}  // namespace
}  // namespace meshwind
