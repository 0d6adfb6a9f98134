#include "mesh/smooth/jet_fit.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// z = a x + b y + c x^2 + d x y + e y^2 + cubic terms, moved by a rigid motion.
struct Graph {
    double a = 0.0, b = 0.0, c = 0.0, d = 0.0, e = 0.0;
    double cubic = 0.0;    // of x^3 - 2 x^2 y + y^3
    double quartic = 0.0;  // of x^4 - 3 x y^3

    [[nodiscard]] Vector3d operator()(double x, double y) const {
        return {x, y,
                a * x + b * y + c * x * x + d * x * y + e * y * y +
                    cubic * (x * x * x - 2.0 * x * x * y + y * y * y) +
                    quartic * (x * x * x * x - 3.0 * x * y * y * y)};
    }
};

std::vector<Vector3d> points_on(const Graph& graph, int count, double radius_mm = 5.0) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> side(-radius_mm, radius_mm);
    std::vector<Vector3d> points;
    for (int i = 0; i < count; ++i) {
        const double x = side(random);
        points.push_back(graph(x, side(random)));
    }
    return points;
}

// Polynomials of the fitted degree are reproduced: S of a graph at a flat point is minus its
// Hessian, for a normal along +z.
TEST(FitJet, ReproducesPolynomialsOfItsDegree) {
    for (const int degree : {2, 3, 4}) {
        const Graph graph{.c = -0.01,
                          .d = 0.004,
                          .e = 0.02,
                          .cubic = degree > 2 ? 1e-3 : 0.0,
                          .quartic = degree > 3 ? 1e-4 : 0.0};
        const Eigen::Isometry3d motion = Eigen::Translation3d(30, -20, 7) *
                                         Eigen::AngleAxisd(1.1, Vector3d(1, 2, -0.5).normalized());
        std::vector<Vector3d> points = points_on(graph, 20);
        for (Vector3d& p : points) {
            p = motion * p;
        }
        const Vector3d up = motion.linear() * Vector3d::UnitZ();
        const auto jet = fit_jet(motion * Vector3d::Zero(), up, points, degree);
        ASSERT_TRUE(jet.has_value());
        Matrix3d hessian = Matrix3d::Zero();
        hessian.topLeftCorner<2, 2>() << 2.0 * graph.c, graph.d, graph.d, 2.0 * graph.e;
        const Matrix3d exact = -motion.linear() * hessian * motion.linear().transpose();
        // Rounding of coordinates of 30 mm over 5 mm, amplified at most a hundredfold by the fit.
        EXPECT_LT((jet->normal - up).norm(), 1e-13);
        EXPECT_LT((jet->shape_operator_per_mm - exact).norm(), 1e-13);
    }
}

// The normal of a tilted plane is found from a guess that is off, and stays on the guess's side.
TEST(FitJet, FindsATiltedPlaneOnTheSideOfTheGuess) {
    const std::vector<Vector3d> points = points_on({.a = 0.3, .b = -0.2}, 20);
    const Vector3d exact = Vector3d(-0.3, 0.2, 1.0).normalized();
    for (const double side : {-1.0, 1.0}) {
        const auto jet = fit_jet(Vector3d::Zero(), {0, 0, side}, points, 3);
        ASSERT_TRUE(jet.has_value());
        EXPECT_LT((jet->normal - side * exact).norm(), 1e-13);
        EXPECT_LT(jet->shape_operator_per_mm.norm(), 1e-13);
    }
}

TEST(FitJet, IsPositiveWhereConvex) {
    const std::vector<Vector3d> bowl = points_on({.c = -0.01, .e = -0.01}, 20);
    const auto convex = fit_jet(Vector3d::Zero(), Vector3d::UnitZ(), bowl, 2);
    const auto concave = fit_jet(Vector3d::Zero(), -Vector3d::UnitZ(), bowl, 2);
    ASSERT_TRUE(convex && concave);
    EXPECT_NEAR(convex->shape_operator_per_mm(0, 0), 0.02, 1e-13);
    EXPECT_NEAR(concave->shape_operator_per_mm(0, 0), -0.02, 1e-13);
}

// The degree is what the neighbours can carry, with two to spare beyond 14, 9 and 5 unknowns.
TEST(FitJet, FallsBackInDegreeWithTheNeighbours) {
    const Graph graph{.c = 0.01};
    const auto terms = [&](int count) {
        const auto jet = fit_jet(Vector3d::Zero(), Vector3d::UnitZ(), points_on(graph, count));
        return jet ? jet->terms : JetTerms::Averaged;
    };
    EXPECT_EQ(terms(16), JetTerms::Quartic);
    EXPECT_EQ(terms(15), JetTerms::Cubic);
    EXPECT_EQ(terms(11), JetTerms::Cubic);
    EXPECT_EQ(terms(10), JetTerms::Quadratic);
    EXPECT_EQ(terms(7), JetTerms::Quadratic);
    EXPECT_EQ(terms(6), JetTerms::Averaged);
    EXPECT_EQ(terms(0), JetTerms::Averaged);
}

// Long facets between two end circles: y and y^2 cannot be told apart, so the surface is taken as
// ruled along y, and its curvature across is exact up to the fifth-order term of the circle.
TEST(FitJet, TakesLongFacetsAsRuled) {
    constexpr double kRadius_mm = 50.0;
    constexpr double kSegment_rad = 2.0 * kPi / 48.0;
    std::vector<Vector3d> points;
    for (const double y : {0.0, 300.0}) {
        for (int i = -3; i <= 3; ++i) {
            if (i != 0 || y != 0.0) {
                const double angle = kSegment_rad * i;
                points.emplace_back(kRadius_mm * std::sin(angle), y,
                                    kRadius_mm * (std::cos(angle) - 1.0));
            }
        }
    }
    const auto jet = fit_jet(Vector3d::Zero(), Vector3d::UnitZ(), points);
    ASSERT_TRUE(jet.has_value());
    EXPECT_EQ(jet->terms, JetTerms::Reduced);
    Matrix3d exact = Matrix3d::Zero();
    exact(0, 0) = 1.0 / kRadius_mm;
    // Of the next term of the circle's height, x^6 / 16 R^5, at three segments: 0.4^4 / 8.
    EXPECT_LT((jet->shape_operator_per_mm - exact).norm() * kRadius_mm, 3e-3);
    // The other circle's terms come from other places on it: their difference over 300 mm.
    EXPECT_LT((jet->normal - Vector3d::UnitZ()).norm(), 1e-6);
}

TEST(FitJet, RefusesPointsOnALine) {
    std::vector<Vector3d> line;
    const std::vector<Vector3d> one_place(20, Vector3d(1, 2, 0));
    for (int i = 1; i <= 20; ++i) {
        line.emplace_back(i, 0, 0);
    }
    EXPECT_FALSE(fit_jet(Vector3d::Zero(), Vector3d::UnitZ(), line));
    EXPECT_FALSE(fit_jet(Vector3d::Zero(), Vector3d::UnitZ(), one_place));
}

// All neighbours in the centre itself (radius 0) or not a number: refused, never a NaN normal.
TEST(FitJet, RefusesWhatIsNoNumber) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Vector3d> same(20, Vector3d::Zero());
    std::vector<Vector3d> broken = points_on({.c = 0.01}, 20);
    broken[7].z() = nan;
    EXPECT_FALSE(fit_jet(Vector3d::Zero(), Vector3d::UnitZ(), same, 3));
    EXPECT_FALSE(fit_jet(Vector3d::Zero(), Vector3d::UnitZ(), broken, 3));
}

// At the end of a wall there are neighbours on one side alone, here in three rows of a cylinder as
// even meshes have them beside a rim. Three rows hardly tell a cubic: what a polynomial misses
// would come out in its slope, 12 deg of it.
TEST(FitJet, LooksStraightAlongACylinderFromItsEnd) {
    constexpr double kRadius_mm = 17.0;
    const auto at = [](double depth_mm, double arc_mm) {
        const double angle = arc_mm / kRadius_mm;
        return Vector3d(depth_mm, kRadius_mm * std::sin(angle), kRadius_mm * std::cos(angle));
    };
    std::vector<Vector3d> neighbours;
    for (const double arc : {3.24, 6.48}) {
        neighbours.insert(neighbours.end(), {at(0.0, arc), at(0.0, -arc)});
    }
    for (const double arc : {2.18, 0.56, 4.3, 2.99, 3.49}) {
        neighbours.insert(neighbours.end(), {at(2.65, arc), at(2.65, -arc)});
    }
    for (const double arc : {1.11, 2.73, 0.3}) {
        neighbours.insert(neighbours.end(), {at(5.31, arc), at(5.31, -arc)});
    }
    neighbours.push_back(at(2.65, -0.15));
    for (const double tilt_deg : {-2.0, -1.0, 0.0, 1.0, 2.0}) {  // of facets beside the end
        const double tilt = rad_from_deg(tilt_deg);
        const auto jet =
            fit_jet(at(0.0, 0.0), Vector3d(std::sin(tilt), 0.0, std::cos(tilt)), neighbours);
        ASSERT_TRUE(jet);
        EXPECT_LT(deg_from_rad(std::acos(std::min(1.0, jet->normal.z()))), 0.3) << tilt_deg;
    }
}

// A guess 60 deg off the true normal: the heights are no function any user meant.
TEST(FitJet, RefusesANormalFarFromTheGuess) {
    const std::vector<Vector3d> points = points_on({}, 20);
    const Vector3d guess(std::sin(1.05), 0.0, std::cos(1.05));
    EXPECT_FALSE(fit_jet(Vector3d::Zero(), guess, points, 3));
}

// S d = dn holds exactly between radial normals of a cylinder: both are R and 1 times sin(angle).
TEST(JetFromNormals, IsExactOnACylinder) {
    constexpr double kRadius_mm = 50.0;
    std::vector<Vector3d> points;
    std::vector<Vector3d> normals;
    for (const double angle : {-0.4, -0.1, 0.2, 0.5}) {
        for (const double z : {-10.0, 0.0, 20.0}) {
            normals.emplace_back(std::cos(angle), std::sin(angle), 0.0);
            points.push_back(kRadius_mm * normals.back() + Vector3d(0, 0, z));
        }
    }
    const Matrix3d s = jet_from_normals({kRadius_mm, 0, 0}, Vector3d::UnitX(), points, normals)
                           .shape_operator_per_mm;
    Matrix3d exact = Matrix3d::Zero();
    exact(1, 1) = 1.0 / kRadius_mm;
    EXPECT_LT((s - exact).norm(), 1e-15);
}

TEST(JetFromNormals, IsZeroWithoutNeighbours) {
    const Jet jet = jet_from_normals(Vector3d::Zero(), Vector3d::UnitZ(), {}, {});
    EXPECT_EQ(jet.shape_operator_per_mm.norm(), 0.0);
    EXPECT_EQ(jet.normal, Vector3d::UnitZ());
}

}  // namespace
}  // namespace meshwind
