// Wyes and crosses: equal pipes in one plane with a rolling-ball blend between neighbours.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/error.h"
#include "core/units.h"
#include "mesh/shapes/analytic.h"
#include "mesh/shapes/make.h"
#include "tests/support/mesh_measures.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Rounding of coordinates of some 100 mm through a few square roots: a thousandth of this.
constexpr double kOnSurface_mm = 1e-9;

struct Star {
    WyeShape wye;
    CrossShape cross;
    bool is_wye = true;

    explicit Star(const WyeShape& shape) : wye(shape) {}
    explicit Star(const CrossShape& shape) : cross(shape), is_wye(false) {}

    [[nodiscard]] TriangleSoup mesh(const MakeOptions& options = {}) const {
        return is_wye ? make_wye(wye, options) : make_cross(cross, options);
    }
    [[nodiscard]] ShapeFoot foot(const Vector3d& p) const {
        return is_wye ? wye_foot(wye, p) : cross_foot(cross, p);
    }
    [[nodiscard]] double pipe_mm() const {
        return is_wye ? wye.pipe_radius_mm : cross.pipe_radius_mm;
    }
    [[nodiscard]] double blend_mm() const {
        return is_wye ? wye.blend_radius_mm : cross.blend_radius_mm;
    }
    // Ends of the axes.
    [[nodiscard]] std::vector<Vector3d> ends_mm() const {
        if (is_wye) {
            const Vector3d arm = wye.arm_length_mm * Vector3d(std::sin(0.5 * wye.angle_rad), 0.0,
                                                              std::cos(0.5 * wye.angle_rad));
            return {{0.0, 0.0, -wye.stem_length_mm}, arm, {-arm.x(), 0.0, arm.z()}};
        }
        const double half_mm = 0.5 * cross.run_length_mm;
        return {{0.0, 0.0, half_mm},
                {0.0, 0.0, -half_mm},
                {cross.branch_length_mm, 0.0, 0.0},
                {-cross.branch_length_mm, 0.0, 0.0}};
    }
};

class MakeStar : public testing::TestWithParam<Star> {};

TEST_P(MakeStar, IsAnOrientedManifoldWithARimForEachPipe) {
    const test::MeshMeasures measures = test::measure(GetParam().mesh());
    const auto pipes = static_cast<int>(GetParam().ends_mm().size());
    EXPECT_TRUE(measures.oriented_manifold);
    EXPECT_EQ(measures.euler, 2 - pipes);
    EXPECT_EQ(measures.rims, pipes);
}

TEST_P(MakeStar, HasEvenTriangles) {
    const test::MeshMeasures measures = test::measure(GetParam().mesh({.edge_mm = 4.0}));
    EXPECT_GT(measures.min_edge_mm, 0.5 * 4.0);
    EXPECT_LT(measures.max_edge_mm, 1.5 * 4.0);
    EXPECT_GT(measures.min_angle_deg, 30.0);
}

// By what a rolling ball is: no ball that touches two pipes from outside and no pipe reaches over a
// vertex, and a pipe or such a ball touches it. The balls' centres are searched for along rays
// between the pipes, where the distance of both axes is that of pipe and ball together.
TEST_P(MakeStar, HasItsVerticesWhereARollingBallLeavesThem) {
    const std::vector<Vector3d> ends_mm = GetParam().ends_mm();
    const double ball_mm = GetParam().blend_mm();
    const double offset_mm = GetParam().pipe_mm() + ball_mm;
    const auto off_pipes = [&](const Vector3d& p) {
        double least = HUGE_VAL;
        for (const Vector3d& end : ends_mm) {
            const double along = p.dot(end) / end.norm();
            least = std::min(least, along > 0.0 ? p.cross(end).norm() / end.norm() : p.norm());
        }
        return least - GetParam().pipe_mm();
    };
    // Centres are up to 4 mm apart along the crotch: half of that beside a vertex, seen over a ball
    // of 6 mm, is 0.33 mm more than the ball.
    constexpr double kBetweenCentres_mm = 0.35;
    std::vector<Vector3d> centres_mm;
    constexpr int kRays = 3000;
    for (int ray = 0; ray < kRays; ++ray) {
        const double around = 2.0 * kPi * ray / kRays;
        for (int height = -40; height <= 40; ++height) {
            const Vector3d from(0.0, offset_mm * std::sin(0.5 * kPi * height / 41.0), 0.0);
            const Vector3d way(std::cos(around), 0.0, std::sin(around));
            double low = 0.0;
            double high = 20.0 * offset_mm;
            if (off_pipes(from + high * way) < ball_mm) {
                continue;  // within a pipe's offset all along
            }
            while (high - low > 1e-10) {
                const double middle = 0.5 * (low + high);
                (off_pipes(from + middle * way) < ball_mm ? low : high) = middle;
            }
            centres_mm.emplace_back(from + high * way);
        }
    }
    const TriangleSoup soup = GetParam().mesh({.edge_mm = 8.0});
    for (const Vector3d& point : soup.points_mm) {
        const ShapeFoot foot = GetParam().foot(point);
        ASSERT_LT(std::abs(foot.distance_mm), kOnSurface_mm);
        const double off_mm = off_pipes(point);
        ASSERT_GT(off_mm, -kOnSurface_mm);
        if (foot.part != ShapePart::Blend) {
            ASSERT_LT(off_mm, kOnSurface_mm);
        }
        double nearest_mm = HUGE_VAL;
        for (const Vector3d& centre : centres_mm) {
            nearest_mm = std::min(nearest_mm, (centre - point).norm());
        }
        ASSERT_GT(nearest_mm, ball_mm - kOnSurface_mm);
        if (foot.part == ShapePart::Blend) {
            ASSERT_LT(nearest_mm, ball_mm + kBetweenCentres_mm);
        }
    }
}

TEST_P(MakeStar, FacesOutward) {
    const TriangleSoup soup = GetParam().mesh({.edge_mm = 3.0});
    const double turn = 1.2 * 3.0 / std::min(GetParam().blend_mm(), GetParam().pipe_mm());
    for (const auto& [a, b, c] : soup.faces) {
        const Vector3d& p = test::point_of(soup, a);
        const Vector3d& q = test::point_of(soup, b);
        const Vector3d& r = test::point_of(soup, c);
        const Vector3d normal = (q - p).cross(r - p).normalized();
        const Vector3d exact = GetParam().foot((p + q + r) / 3.0).normal;
        ASSERT_LT(std::atan2(normal.cross(exact).norm(), normal.dot(exact)), turn);
    }
}

TEST_P(MakeStar, EndsInCircles) {
    const TriangleSoup soup = GetParam().mesh();
    for (const Vector3d& end : GetParam().ends_mm()) {
        int on_rim = 0;
        for (const Vector3d& point : soup.points_mm) {
            on_rim += std::abs(point.dot(end) / end.norm() - end.norm()) < kOnSurface_mm ? 1 : 0;
        }
        EXPECT_EQ(on_rim, std::lround(2.0 * kPi * GetParam().pipe_mm() / 5.0));
    }
}

TEST_P(MakeStar, FindsTheFootOfPointsOffTheSurface) {
    for (const Vector3d& point : GetParam().mesh().points_mm) {
        const Vector3d normal = GetParam().foot(point).normal;
        for (const double off : {-2.0, 0.5, 2.0}) {
            const ShapeFoot foot = GetParam().foot(point + off * normal);
            ASSERT_NEAR(foot.distance_mm, off, kOnSurface_mm);
            // The foot moves with the square root of rounding along the crotch.
            ASSERT_LT((foot.point_mm - point).norm(), 1e-6);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, MakeStar,
                         testing::Values(Star(WyeShape{}),
                                         Star(WyeShape{40, 15, 200, 200, 2.0 * kPi / 3.0}),
                                         Star(WyeShape{30, 6, 100, 220, kPi / 4.0}),
                                         Star(WyeShape{50, 10, 250, 200, 5.0 * kPi / 6.0}),
                                         Star(CrossShape{}), Star(CrossShape{30, 25, 300, 120})));

TEST(WyeFoot, IsTheEqualTeesWhereTheArmsAreInLine) {
    const TeeShape tee{40, 40, 15, 400, 200};
    const WyeShape wye{40, 15, 200, 200, kPi};
    for (const Vector3d& p : make_tee(tee).points_mm) {
        const Vector3d off = p + 1.5 * tee_foot(tee, p).normal;
        const ShapeFoot expected = tee_foot(tee, off);
        const ShapeFoot foot = wye_foot(wye, {off.z(), off.y(), -off.x()});
        ASSERT_NEAR(foot.distance_mm, expected.distance_mm, kOnSurface_mm);
        const Vector3d& q = expected.point_mm;
        ASSERT_LT((foot.point_mm - Vector3d(q.z(), q.y(), -q.x())).norm(), 1e-6);
    }
}

TEST(CrossFoot, IsTheEqualTeesOnEitherSide) {
    const TeeShape tee{40, 40, 15, 400, 200};
    const CrossShape cross{40, 15, 400, 200};
    for (const Vector3d& p : make_tee(tee).points_mm) {
        if (p.x() > 1.0) {
            const Vector3d off = p + 1.5 * tee_foot(tee, p).normal;
            const Vector3d expected = tee_foot(tee, off).point_mm;
            ASSERT_LT((cross_foot(cross, off).point_mm - expected).norm(), 1e-6);
            const Vector3d mirrored(-off.x(), off.y(), off.z());
            ASSERT_LT((cross_foot(cross, mirrored).point_mm -
                       Vector3d(-expected.x(), expected.y(), expected.z()))
                          .norm(),
                      1e-6);
        }
    }
}

template <class Make, class Shape>
std::string code_of(const Make& make, const Shape& shape, double edge_mm = 5.0) {
    try {
        (void)make(shape, {.edge_mm = edge_mm});
    } catch (const InputError& error) {
        return error.code();
    }
    return "none";
}

TEST(MakeStar, RefusesImpossibleShapes) {
    EXPECT_EQ(code_of(make_wye, WyeShape{0, 15, 200, 200, 1.5}), "make.not_positive");
    EXPECT_EQ(code_of(make_wye, WyeShape{40, std::nan(""), 200, 200, 1.5}), "make.not_positive");
    EXPECT_EQ(code_of(make_wye, WyeShape{40, 15, 200, 200, 0.3}), "make.arms_angle");
    EXPECT_EQ(code_of(make_wye, WyeShape{40, 15, 200, 200, 3.0}), "make.arms_angle");
    EXPECT_EQ(code_of(make_wye, WyeShape{40, 25, 200, 200, kPi / 4.0}), "make.blend_too_large");
    EXPECT_EQ(code_of(make_wye, WyeShape{40, 15, 200, 120, 0.8}), "make.leg_too_short");
    EXPECT_EQ(code_of(make_wye, WyeShape{40, 15, 20, 200, 1.5}), "make.leg_too_short");
    EXPECT_EQ(code_of(make_wye, WyeShape{}, 30.0), "make.edge_too_large");
    EXPECT_EQ(code_of(make_cross, CrossShape{40, 15, -1, 200}), "make.not_positive");
    EXPECT_EQ(code_of(make_cross, CrossShape{40, 80, 600, 300}), "make.blend_too_large");
    EXPECT_EQ(code_of(make_cross, CrossShape{40, 15, 400, 50}), "make.leg_too_short");
}

TEST(MakeStar, HasAnInnerWallOfItsOwn) {
    const TriangleSoup solid = make_wye({}, {.solid = true, .wall_mm = 4.0});
    const test::MeshMeasures measures = test::measure(solid);
    EXPECT_TRUE(measures.oriented_manifold);
    EXPECT_EQ(measures.rims, 0);
    EXPECT_EQ(measures.euler, -2);  // of a ball with two handles
}

}  // namespace
}  // namespace meshwind
