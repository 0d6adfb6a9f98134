#include "postproc/ringhead/tube_axis.h"

#include <cmath>

#include <gtest/gtest.h>

#include "mesh/mandrel/load_mandrel.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/l_frame.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// The paper's frame as a mesh, moved anywhere.
TriangleSoup l_frame_mesh(double edge_mm, bool irregular, const Isometry3d& pose) {
    TriangleSoup soup = make_mandrel("frame",
                                     {{"pipe-radius", 20.0},
                                      {"bend-radius", test::kBendRadius_mm},
                                      {"leg1", test::kArm_mm},
                                      {"leg2", test::kFrame_mm - test::kBendEnd_mm}},
                                     {.edge_mm = edge_mm, .irregular = irregular});
    for (Vector3d& point : soup.points_mm) {
        point = pose * point;
    }
    return soup;
}

TEST(TubeAxis, LFrameIsFoundFromItsMesh) {
    Isometry3d moved = Isometry3d::Identity();
    moved.linear() = Eigen::AngleAxisd(1.1, Vector3d(1.0, -2.0, 0.5).normalized()).matrix();
    moved.translation() = Vector3d(300.0, -40.0, 120.0);
    for (const Isometry3d& pose : {Isometry3d::Identity(), moved}) {
        for (const bool irregular : {false, true}) {
            const Mandrel mandrel =
                build_mandrel(l_frame_mesh(4.0, irregular, pose), "frame", {.unit_mm = 1.0});
            const TubeFinding finding = find_tube(mandrel);
            ASSERT_TRUE(finding.tube) << finding.why_not;
            TubeAxisOptions options;
            options.bend_turn_rad = kPi;
            TubeAxis found = axis_of_tube(*finding.tube, options);
            if (found.axis.at(450.0).tangent.z() < 0.5) {  // the short arm is first
                options.from_the_end = true;
                found = axis_of_tube(*finding.tube, options);
            }
            EXPECT_NEAR(found.radius_mm, 20.0, 1e-3);
            EXPECT_LT(found.radius_spread_mm, 1e-2);
            EXPECT_NEAR(found.axis.length_mm(), test::kFrame_mm, 0.01);
            for (double s = 0.0; s <= test::kFrame_mm; s += 7.0) {
                const AxisFrame at = found.axis.at(s);
                const AxisFrame exact = test::l_frame_at(s);
                EXPECT_LT((at.point_mm - exact.point_mm).norm(), 0.01) << s;
                EXPECT_LT((at.tangent - exact.tangent).norm(), 1e-4) << s;
                EXPECT_LT((at.reference - exact.reference).norm(), 1e-3) << s;
            }
        }
    }
}

TEST(TubeAxis, OtherEndAndStraightTubes) {
    const Mandrel mandrel =
        build_mandrel(l_frame_mesh(4.0, false, Isometry3d::Identity()), "frame", {.unit_mm = 1.0});
    const TubeFinding finding = find_tube(mandrel);
    ASSERT_TRUE(finding.tube) << finding.why_not;
    TubeAxisOptions options;
    options.bend_turn_rad = kPi;
    const TubeAxis forth = axis_of_tube(*finding.tube, options);
    options.from_the_end = true;
    const TubeAxis back = axis_of_tube(*finding.tube, options);
    const double length = forth.axis.length_mm();
    EXPECT_NEAR(back.axis.length_mm(), length, 1e-6);
    for (double s = 0.0; s <= length; s += 7.0) {
        const Vector3d one = forth.in_mandrel * forth.axis.at(s).point_mm;
        const Vector3d other = back.in_mandrel * back.axis.at(length - s).point_mm;
        EXPECT_LT((one - other).norm(), 1e-3) << s;
    }
    EXPECT_NEAR(back.axis.stations().back().turn_rad, kPi, 1e-12);
    EXPECT_NEAR(back.axis.at(100.0).reference.y(), 1.0, 1e-12) << "no turn on an arm";
    // Inside of the bend is +x from either end.
    EXPECT_GT(back.axis.at(500.0).point_mm.x(), 10.0);
    const TubeFinding pipe = find_tube(build_mandrel(
        make_mandrel("cylinder", {{"radius", 15.0}, {"length", 200.0}}, {.edge_mm = 4.0}), "pipe",
        {.unit_mm = 1.0}));
    ASSERT_TRUE(pipe.tube) << pipe.why_not;
    const TubeAxis straight = axis_of_tube(*pipe.tube, options);
    EXPECT_NEAR(straight.axis.length_mm(), 200.0, 1e-3);
    EXPECT_LT(straight.axis.at(200.0).point_mm.head<2>().norm(), 1e-3);
    EXPECT_EQ(straight.axis.stations().back().turn_rad, 0.0);
}

}  // namespace
}  // namespace meshwind
