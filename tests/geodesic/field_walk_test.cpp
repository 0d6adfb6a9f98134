#include "geodesic/field_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "mesh/shapes/make.h"
#include "tests/support/reference.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

Surface torus(double edge_mm) {
    return test::frozen(make_torus({.ring_radius_mm = 200.0, .tube_radius_mm = 50.0},
                                   {.edge_mm = edge_mm, .irregular = true}));
}

const Surface& cylinder() {
    static const Surface kSurface = test::frozen(make_cylinder(
        {.radius_mm = 50.0, .length_mm = 300.0}, {.edge_mm = 5.0, .irregular = true}));
    return kSurface;
}

// Flat squares of 5 mm over 100 x 100 mm; beyond x = 0 the plate is tilted by `slope`.
Surface plate(double slope = 0.0) {
    TriangleSoup soup;
    const auto index = [](int i, int j) { return 21 * i + j; };
    for (int i = 0; i <= 20; ++i) {
        for (int j = 0; j <= 20; ++j) {
            const double x = 5.0 * i - 50.0;
            soup.points_mm.emplace_back(x, 5.0 * j - 50.0, slope * std::max(0.0, x));
            if (i < 20 && j < 20) {
                soup.faces.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
                soup.faces.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
            }
        }
    }
    return test::frozen(soup);
}

// Everywhere into one direction of space, without an end.
AimField constant(const Vector3d& direction) {
    return [direction](const Vector3d&, const Vector3d&) {
        return Aim{direction, -1.0, 1e-9, 0.0};
    };
}

// As a fibre is laid that runs to a standing eye.
AimField towards(const Vector3d& eye) {
    return [eye](const Vector3d& x, const Vector3d& n) {
        return Aim{eye - x, n.dot(eye - x), 0.0, (eye - x).norm()};
    };
}

// At an angle to the parallels about z, up to a height; \pre on a cylinder about z.
AimField helical(double angle_rad, double end_z_mm) {
    return [angle_rad, end_z_mm](const Vector3d& x, const Vector3d&) {
        const Vector3d around = Vector3d(-x.y(), x.x(), 0.0).normalized();
        return Aim{std::cos(angle_rad) * around + std::sin(angle_rad) * Vector3d::UnitZ(),
                   x.z() - end_z_mm, std::sin(angle_rad), 0.0};
    };
}

// The integral curve of a field on an exact torus by the classical Runge-Kutta method: steps of
// 0.25 mm leave (0.25 / 50)^4, 6e-10, of a mm per mm.
Vector3d integrated(Vector3d x, double length_mm, const AimField& field) {
    const test::ExactTorus shape;
    const auto rate = [&](const Vector3d& p) -> Vector3d {
        const Vector3d n = shape.normal(p);
        const Vector3d d = field(p, n).direction;
        return (d - n * n.dot(d)).normalized();
    };
    const int steps = static_cast<int>(std::ceil(length_mm / 0.25));
    const double h = length_mm / steps;
    for (int i = 0; i < steps; ++i) {
        const Vector3d a = rate(x);
        const Vector3d b = rate(x + 0.5 * h * a);
        const Vector3d c = rate(x + 0.5 * h * b);
        x += h / 6.0 * (a + 2.0 * b + 2.0 * c + rate(x + h * c));
    }
    return x;
}

TEST(FieldWalk, CylinderHelixEndsWhereTheClosedFormSays) {
    const double angle = rad_from_deg(25.0);
    FieldWalker walker(cylinder(), test::patch_point(cylinder(), {50.0, 0.0, -100.0}));
    const FieldWalk walk = walker.walk(helical(angle, 80.0), kNoLimit, kNoLimit);
    EXPECT_EQ(walk.stop, FieldStop::Arrived);
    // kArrival_mm of field_walk.cpp.
    EXPECT_NEAR(walker.position_mm().z(), 80.0, 2e-9);
    const double azimuth = 180.0 / std::tan(angle) / 50.0;
    const Vector3d expected(50.0 * std::cos(azimuth), 50.0 * std::sin(azimuth), 80.0);
    // Normals of fourth order, h = R / 10, scattered over an irregular mesh.
    EXPECT_NEAR(walk.length_mm, 180.0 / std::sin(angle), 1e-4);
    EXPECT_LT((walker.position_mm() - expected).norm(), 1e-3);
}

// From theta off the line to an eye 180 mm from the middle of a ball of 100 mm the fibre is laid
// along the great circle until the eye is in the tangent plane, acos(100 / 180) off the line.
TEST(FieldWalk, TowardsAnEyeOverABallIsTheGreatCircleToTheTangent) {
    const Surface ball = test::frozen(
        make_ellipsoid({.equator_radius_mm = 100.0, .pole_radius_mm = 100.0}, {.edge_mm = 6.0}));
    const Vector3d to_eye = Vector3d(0.3, 0.8, 0.5).normalized();
    const Vector3d aside = to_eye.unitOrthogonal();
    const double theta = 2.0;
    FieldWalker walker(ball, test::patch_point(ball, 100.0 * (std::cos(theta) * to_eye +
                                                              std::sin(theta) * aside)));
    const FieldWalk walk = walker.walk(towards(180.0 * to_eye), kNoLimit, 5.0);
    EXPECT_EQ(walk.stop, FieldStop::Arrived);
    const double end = std::acos(100.0 / 180.0);
    const Vector3d expected = 100.0 * (std::cos(end) * to_eye + std::sin(end) * aside);
    // Steps of 5 mm over 100 mm, (5 / 100)^4 of their 145 mm, / 120 in Runge-Kutta's error term.
    EXPECT_NEAR(walk.length_mm, 100.0 * (theta - end), 5e-5);
    EXPECT_LT((walker.position_mm() - expected).norm(), 5e-5);
}

// Walks on the outer half of the torus towards points beside it, over three meshes.
TEST(FieldWalk, OnATorusIsOfFourthOrderInTheEdgeLength) {
    const test::ExactTorus shape;
    std::vector<double> off_mm;
    for (const double edge_mm : {10.0, 5.0, 2.5}) {
        const Surface surface = torus(edge_mm);
        double squares = 0.0;
        for (int k = 0; k < 10; ++k) {
            const double u = 0.6 * k;
            const Vector3d out(std::cos(u), std::sin(u), 0.0);
            const Vector3d start = shape.foot(240.0 * out + Vector3d(0.0, 0.0, 10.0 - 3.0 * k));
            const AimField field = [&](const Vector3d& x, const Vector3d&) {
                return Aim{Vector3d::UnitZ().cross(x) / 250.0 +
                               std::sin(0.02 * x.z() + k) * Vector3d::UnitZ(),
                           -1.0, 1e-9, 0.0};
            };
            FieldWalker walker(surface, test::patch_point(surface, start));
            const FieldWalk walk = walker.walk(field, 100.0, kNoLimit);
            EXPECT_EQ(walk.stop, FieldStop::Length);
            EXPECT_NEAR(walk.length_mm, 100.0, 1e-9);
            squares +=
                (walker.position_mm() - integrated(start, 100.0, field)).squaredNorm() / 10.0;
        }
        off_mm.push_back(std::sqrt(squares));
    }
    // 9e-4, 2e-5 and 1e-6 mm: irregular meshes scatter the order by about a half.
    EXPECT_LT(off_mm[2], 5e-6);
    EXPECT_GT(std::log2(off_mm[0] / off_mm[2]) / 2.0, 3.5);
}

TEST(FieldWalk, ShortStepsAreAsGoodAsThoseFromEdgeToEdge) {
    const Surface surface = torus(5.0);
    const AimField field = constant({0.2, 1.0, 0.6});
    std::array<Vector3d, 2> end;
    for (const std::size_t k : {0U, 1U}) {
        FieldWalker walker(surface, test::patch_point(surface, {250.0, 0.0, 0.0}));
        EXPECT_EQ(walker.walk(field, 60.0, k == 0 ? kNoLimit : 0.5).stop, FieldStop::Length);
        end[k] = walker.position_mm();
    }
    // Steps of up to 5 mm where the wall bends by 1 / 50 mm: (5 / 50)^4 / 120 of 60 mm.
    EXPECT_LT((end[0] - end[1]).norm(), 5e-5);
}

TEST(FieldWalk, GoesBackTheWayItCame) {
    const Surface surface = torus(5.0);
    const AimField there = constant({0.2, 1.0, 0.6});
    const AimField back = constant({-0.2, -1.0, -0.6});
    FieldWalker walker(surface, test::patch_point(surface, {250.0, 0.0, 0.0}));
    const Vector3d start = walker.position_mm();
    (void)walker.walk(there, 60.0, kNoLimit);
    EXPECT_GT((walker.position_mm() - start).norm(), 50.0);
    (void)walker.walk(back, 60.0, kNoLimit);
    // The same steps from edge to edge back, but for their own error.
    EXPECT_LT((walker.position_mm() - start).norm(), 5e-5);
}

TEST(FieldWalk, ShowsEveryEdgeThatItCrosses) {
    const double angle = rad_from_deg(25.0);
    FieldWalker walker(cylinder(), test::patch_point(cylinder(), {50.0, 0.0, -100.0}));
    SurfacePath seen;
    const FieldWalk walk = walker.walk(helical(angle, 80.0), kNoLimit, kNoLimit,
                                       [&](const PathPoint& p) { seen.push_back(p); });
    ASSERT_GT(seen.size(), 100U);
    double s_mm = 0.0;
    for (const PathPoint& p : seen) {
        ASSERT_GE(p.s_mm, s_mm);
        s_mm = p.s_mm;
        // The end of a step on an edge is that good (kOutside of field_walk.cpp).
        ASSERT_LT(p.at.bary.minCoeff(), 1e-9);
        ASSERT_NEAR(p.tangent.norm(), 1.0, 1e-12);
        ASSERT_NEAR(p.tangent.dot(p.normal), 0.0, 1e-12);
        ASSERT_NEAR(p.tangent.z(), std::sin(angle), 1e-3);
        ASSERT_NEAR(p.position_mm.z(), -100.0 + p.s_mm * std::sin(angle), 1e-3);
    }
    EXPECT_LE(s_mm, walk.length_mm);
}

TEST(FieldWalk, StopsAtTheRimAndNamesIt) {
    for (const double way : {-1.0, 1.0}) {
        FieldWalker walker(cylinder(), test::patch_point(cylinder(), {50.0, 0.0, 0.0}));
        const FieldWalk walk = walker.walk(constant({0.0, 0.0, way}), kNoLimit, kNoLimit);
        ASSERT_EQ(walk.stop, FieldStop::Rim);
        // Fits at the rim see one side only and lift its edges' middles by a few um.
        EXPECT_NEAR(walk.length_mm, 150.0, 5e-3);
        EXPECT_NEAR(walker.position_mm().z(), 150.0 * way, 5e-3);
        const auto& rim = cylinder().rim[static_cast<std::size_t>(walker.face())];
        EXPECT_EQ(walk.rim, *std::max_element(rim.begin(), rim.end()));
        EXPECT_GE(walk.rim, 0);
    }
}

TEST(FieldWalk, HasArrivedWhereItsEndIsBehind) {
    FieldWalker walker(cylinder(), test::patch_point(cylinder(), {50.0, 0.0, 0.0}));
    const FieldWalk walk = walker.walk(helical(0.5, -10.0), kNoLimit, kNoLimit);
    EXPECT_EQ(walk.stop, FieldStop::Arrived);
    EXPECT_EQ(walk.length_mm, 0.0);
}

// All faces around a vertex lead to it: the walk must see that it gets nowhere.
TEST(FieldWalk, EndsAtAVertexThatTheFieldLeadsTo) {
    const Surface surface = plate();
    const Vector3d vertex(10.0, 15.0, 0.0);
    FieldWalker walker(surface, test::patch_point(surface, {-21.0, -13.0, 0.0}));
    std::size_t crossed = 0;
    const FieldWalk walk = walker.walk(
        [&](const Vector3d& x, const Vector3d&) {
            return Aim{vertex - x, -1.0, 1e-9, 0.0};
        },
        1000.0, 5.0, [&](const PathPoint&) { ++crossed; });
    EXPECT_NE(walk.stop, FieldStop::Arrived);
    EXPECT_LT((walker.position_mm() - vertex).norm(), 5.0);
    EXPECT_LT(crossed, 1000U);
}

// On the inner half of a torus, along the ring, the wall is hollow: as the place moves on, the eye
// sinks further under its plane.
TEST(FieldWalk, StallsWhereTheEndGoesAway) {
    const Surface surface = torus(5.0);
    FieldWalker walker(surface, test::patch_point(surface, {150.0, 0.0, 0.0}));
    const FieldWalk walk = walker.walk(towards({151.0, 60.0, 0.0}), kNoLimit, 5.0);
    EXPECT_EQ(walk.stop, FieldStop::Stalled);
    EXPECT_EQ(walk.length_mm, 0.0);
}

// Flat wall neither raises nor lowers the eye: under the plane the walk goes on, in it it ends.
TEST(FieldWalk, GoesOnOverFlatWallOnlyUnderAnEyeBelowIt) {
    const Surface flat = plate();
    const SurfacePoint start = test::patch_point(flat, {-18.0, 4.0, 0.0});
    FieldWalker below(flat, start);
    const FieldWalk walk = below.walk(towards({102.0, 44.0, -1.0}), kNoLimit, 5.0);
    EXPECT_EQ(walk.stop, FieldStop::Rim);
    // The straight way to x = 50, but for kArrival_mm at each edge.
    EXPECT_NEAR(walk.length_mm, 68.0 * std::hypot(1.0, 40.0 / 120.0), 1e-7);
    FieldWalker inside(flat, start);
    const FieldWalk none = inside.walk(towards({102.0, 44.0, -1e-5}), kNoLimit, 5.0);
    EXPECT_EQ(none.stop, FieldStop::Stalled);
    EXPECT_EQ(none.length_mm, 0.0);
}

// Both sides of an edge lead into the other one: what is left is the way along it.
TEST(FieldWalk, SlidesAlongAnEdgeThatBothSidesLeadInto) {
    const Surface roof = plate(-1.0);
    FieldWalker walker(roof, test::patch_point(roof, {-12.0, -29.0, 0.0}));
    const AimField field = [](const Vector3d& x, const Vector3d& n) {
        const double side = n.x() > 0.1 ? -1.0 : 1.0;
        return Aim{Vector3d(side, 0.5, 0.0), x.y() - 20.0, 0.1, 0.0};
    };
    const FieldWalk walk = walker.walk(field, 1000.0, 2.0);
    EXPECT_EQ(walk.stop, FieldStop::Arrived);
    EXPECT_NEAR(walker.position_mm().x(), 0.0, 1e-6);
    EXPECT_NEAR(walker.position_mm().y(), 20.0, 1e-6);
    // 12 mm across take 6 mm along; kArrival_mm at each edge passed.
    EXPECT_NEAR(walk.length_mm, std::hypot(12.0, 6.0) + 43.0, 1e-6);
}

// The last edge crossed says nothing of where the next field leads: at a vertex most lead back.
TEST(FieldWalk, LeavesAVertexIntoAnyDirection) {
    const Surface flat = plate();
    constexpr double kWay_mm = 12.0;
    for (int from = 0; from < 16; ++from) {
        for (int into = 0; into < 16; ++into) {
            const auto direction = [](int i) {
                const double angle = 2.0 * kPi * (i + 0.3) / 16.0;
                return Vector3d(std::cos(angle), std::sin(angle), 0.0);
            };
            FieldWalker walker(flat, test::patch_point(flat, 3.0 * direction(from)));
            ASSERT_TRUE(walker.move_under(Vector3d::Zero()));
            (void)walker.walk(constant(direction(from)), 1e-12, kNoLimit);
            const FieldWalk walk = walker.walk(constant(direction(into)), kWay_mm, kNoLimit);
            EXPECT_EQ(walk.stop, FieldStop::Length);
            EXPECT_LT((walker.position_mm() - kWay_mm * direction(into)).norm(), 1e-6)
                << from << " into " << into;
        }
    }
}

TEST(FieldWalk, ShowsBothSidesOfAFeatureEdge) {
    const Surface roof = plate(-1.0);
    FieldWalker walker(roof, test::patch_point(roof, {-12.0, 1.0, 0.0}));
    SurfacePath ridge;
    (void)walker.walk(constant({1.0, 0.0, 0.0}), 30.0, kNoLimit, [&](const PathPoint& p) {
        if (std::abs(p.position_mm.x()) < 1e-9) {
            ridge.push_back(p);
        }
    });
    ASSERT_EQ(ridge.size(), 2U);
    EXPECT_LT((ridge[0].normal - Vector3d::UnitZ()).norm(), 1e-9);
    EXPECT_LT((ridge[1].normal - Vector3d(1.0, 0.0, 1.0).normalized()).norm(), 1e-9);
    // 18 mm down the other side.
    EXPECT_NEAR(walker.position_mm().x(), 18.0 / std::sqrt(2.0), 1e-9);
}

// Distance to the foot of a random point up to 15 mm off the wall, `way_mm` from the start; the
// largest of 500.
double worst_foot_mm(double way_mm) {
    static const Surface kSurface = torus(5.0);
    const test::ExactTorus shape;
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> height_mm(-15.0, 15.0);
    double worst = 0.0;
    for (int k = 0; k < 500; ++k) {
        const test::Start start = test::random_start(kSurface, random);
        FieldWalker walker(kSurface, start.at);
        const Vector3d there = shape.foot(walker.position_mm() + way_mm * start.direction);
        EXPECT_TRUE(walker.move_under(there + height_mm(random) * shape.normal(there))) << k;
        worst = std::max(worst, (walker.position_mm() - there).norm());
    }
    return worst;
}

// As a straight fibre is followed, in steps of less than an edge, what is left is the patches'
// normals, 3e-5 rad (h = R / 10 to the fourth, a third of it), times 15 mm of height and 1.4 by
// which a foot moves faster than a point 15 mm inside.
TEST(MoveUnder, FindsTheFootOfAPointNearby) {
    EXPECT_LT(worst_foot_mm(0.75), 1e-3);
}

// From far, a step of Newton's method may end just beyond the foot on an edge over which the next
// face may not lead back: 14 of 5000 were off, by up to 0.052 mm.
TEST(MoveUnder, IsNearTheFootOfAPointFurtherOff) {
    EXPECT_LT(worst_foot_mm(20.0), 0.1);
}

TEST(MoveUnder, DoesNotReachBeyondARim) {
    FieldWalker walker(cylinder(), test::patch_point(cylinder(), {50.0, 0.0, 140.0}));
    EXPECT_FALSE(walker.move_under({55.0, 0.0, 151.0}));
    FieldWalker other(cylinder(), test::patch_point(cylinder(), {50.0, 0.0, 140.0}));
    EXPECT_TRUE(other.move_under({55.0, 0.0, 149.0}));
}

// What one point is beyond says nothing of the next: here it lies over the edge that led to a
// vertex.
TEST(MoveUnder, FollowsAPathThatStartsAtAVertex) {
    for (double azimuth_deg = 0.0; azimuth_deg < 360.0; azimuth_deg += 90.0) {
        const auto place = [&](double way_mm) {
            const double turn = rad_from_deg(azimuth_deg) + way_mm / std::sqrt(2.0) / 50.0;
            return Vector3d(50.0 * std::cos(turn), 50.0 * std::sin(turn),
                            150.0 - way_mm / std::sqrt(2.0));
        };
        FieldWalker walker(cylinder(), test::patch_point(cylinder(), place(2.0)));
        for (double way_mm = 0.0; way_mm < 100.0; way_mm += 4.0) {
            (void)walker.move_under(place(way_mm));
            EXPECT_LT((walker.position_mm() - place(way_mm)).norm(), 0.1)
                << azimuth_deg << " deg, " << way_mm << " mm";
        }
    }
}

TEST(FieldWalker, StandsWhereItIsMoved) {
    const Surface flat = plate();
    FieldWalker walker(flat, {0});
    const SurfacePoint place{77, {0.5, 0.2, 0.3}};
    walker.move_to(place);
    EXPECT_EQ(walker.face(), 77);
    EXPECT_LT((walker.position_mm() - position_mm(flat, place)).norm(), 1e-12);
    const PathPoint station = walker.station({3.0, 4.0, 7.0});
    EXPECT_LT((station.tangent - Vector3d(0.6, 0.8, 0.0)).norm(), 1e-9);
    EXPECT_LT((station.at.bary - place.bary).norm(), 1e-12);
    EXPECT_NEAR(station.kn_per_mm, 0.0, 1e-9);
}

}  // namespace
}  // namespace meshwind
