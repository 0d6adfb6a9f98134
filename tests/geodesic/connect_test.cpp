#include "geodesic/connect.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "mesh/ray_query.h"
#include "mesh/shapes/make_kinds.h"
#include "tests/support/reference.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 50.0;
constexpr std::uint64_t kSeed = 5;

Surface made(const char* kind, const MakeValues& values, double edge_mm) {
    return test::frozen(make_mandrel(kind, values, {.edge_mm = edge_mm, .irregular = true}));
}

Surface cylinder(double edge_mm) {
    return made("cylinder", {{"radius", kRadius_mm}, {"length", 240.0}}, edge_mm);
}

Surface sphere(double edge_mm) {
    return made("ellipsoid", {{"equator-radius", 2.0 * kRadius_mm}, {"pole-radius", 100.0}},
                edge_mm);
}

class Snapper {
public:
    explicit Snapper(const Surface& surface)
        : wall_{surface.position_mm, surface.face}, query_({&wall_, 1}) {}

    [[nodiscard]] SurfacePoint operator()(const Vector3d& p) const {
        const ClosestPoint found = query_.closest(p, 1000.0);
        return {found.face, found.bary};
    }

private:
    TriangleSoup wall_;
    RayQuery query_;
};

Vector3d on_cylinder(double turn_rad, double z_mm) {
    return {kRadius_mm * std::cos(turn_rad), kRadius_mm * std::sin(turn_rad), z_mm};
}

// Of what was promised of the end of a path that reached its target: positions on facets agree in
// space, since both are on one.
void expect_reached(const Surface& surface, const ConnectResult& result, const SurfacePoint& from,
                    const SurfacePoint& to) {
    ASSERT_EQ(result.stop, ConnectStop::Reached) << name_of(result.stop) << ", " << result.miss_mm;
    EXPECT_LE(result.miss_mm, 1e-6);
    EXPECT_EQ(result.miss_mm, std::hypot(result.across_mm, result.along_mm));
    EXPECT_EQ(result.length_mm, result.path.back().s_mm);
    EXPECT_LT((result.path.front().position_mm - position_mm(surface, from)).norm(), 1e-12);
    // The facet leans from the tangent plane by up to h / (2 R), under 0.2 here.
    EXPECT_LT((result.path.back().position_mm - position_mm(surface, to)).norm(), 1.1e-6);
}

// Worst over all paths.
struct HelixErrors {
    double length_share = 0.0;  // of the length
    double angle_rad = 0.0;     // at the start
};

void take(HelixErrors& errors, const ConnectResult& result, double length_mm, double angle_rad) {
    errors.length_share =
        std::max(errors.length_share, std::abs(result.length_mm / length_mm - 1.0));
    errors.angle_rad = std::max(errors.angle_rad,
                                std::abs(std::acos(result.path.front().tangent.z()) - angle_rad));
}

// Between points up to 166 degrees apart: the shortest helix.
HelixErrors helix_errors(double edge_mm) {
    const Surface surface = cylinder(edge_mm);
    const Snapper snap(surface);
    const SurfacePoint from = snap(on_cylinder(0.4, -100.0));
    ShortestPaths tree(surface, from);
    HelixErrors errors;
    for (const double turn : {0.3, 1.0, 2.0, -2.9}) {
        for (const double run : {20.0, 90.0, 200.0}) {
            const SurfacePoint to = snap(on_cylinder(0.4 + turn, -100.0 + run));
            const ConnectResult result = connect(surface, from, to, tree.to(to).value());
            expect_reached(surface, result, from, to);
            EXPECT_EQ(result.conjugate_points, 0);
            take(errors, result, std::hypot(kRadius_mm * turn, run),
                 std::atan2(kRadius_mm * std::abs(turn), run));
            // Neighbours on a developable surface part in proportion to the length; the fits'
            // scatter in K is some 1e-6 per mm^2, which over 250 mm is a share of 1e-6 250^2 / 6.
            EXPECT_NEAR(result.jacobi_mm / result.length_mm, 1.0, 0.1);
        }
    }
    return errors;
}

// The facets' way around is short by h^2 / (24 R^2) of itself, 4.2e-4 at h = 5, and the snapped
// points are nearer to the axis by a like share: second order.
TEST(Connect, CylinderHelix) {
    const HelixErrors coarse = helix_errors(10.0);
    const HelixErrors fine = helix_errors(5.0);
    std::printf("helix: h 10 length %.2e, angle %.2e rad; h 5 length %.2e, angle %.2e rad\n",
                coarse.length_share, coarse.angle_rad, fine.length_share, fine.angle_rad);
    EXPECT_LT(fine.length_share, 1.5 * 4.2e-4);
    EXPECT_LT(fine.angle_rad, 2e-3);
    EXPECT_GT(coarse.length_share / fine.length_share, std::exp2(1.5));
}

// Constant slip lambda to the right turns the winding angle from alpha0 to alpha1 over
// z = (R / lambda)(1 / sin alpha0 - 1 / sin alpha1), phi = ln(tan(alpha1 / 2) / tan(alpha0 / 2)) /
// lambda, s = (R / lambda)(cot alpha0 - cot alpha1), since alpha' = lambda sin^2(alpha) / R.
HelixErrors steered_errors(const Surface& surface, ShortestPaths& tree, const SurfacePoint& from,
                           double slip_ratio) {
    const Snapper snap(surface);
    const double lambda = std::abs(slip_ratio);
    const double side = slip_ratio < 0.0 ? 1.0 : -1.0;  // to the right: counter-clockwise about z
    HelixErrors errors;
    for (const auto& [alpha0, alpha1] :
         {std::pair{0.5, 0.6}, std::pair{0.8, 1.1}, std::pair{1.2, 1.7}}) {
        const double z = kRadius_mm / lambda * (1.0 / std::sin(alpha0) - 1.0 / std::sin(alpha1));
        const double turn = std::log(std::tan(0.5 * alpha1) / std::tan(0.5 * alpha0)) / lambda;
        const SurfacePoint to = snap(on_cylinder(0.1 + side * turn, -100.0 + z));
        const ConnectResult result = connect(surface, from, to, tree.to(to).value(), slip_ratio);
        expect_reached(surface, result, from, to);
        take(errors, result,
             kRadius_mm / lambda * (1.0 / std::tan(alpha0) - 1.0 / std::tan(alpha1)), alpha0);
    }
    return errors;
}

// Measured at 10 and 5 mm: lengths off by 1.2e-3 and 2e-4, start angles by 9e-3 and 2e-3 rad.
TEST(Connect, CylinderWithSlip) {
    std::vector<HelixErrors> found;
    for (const double edge : {10.0, 5.0}) {
        const Surface surface = cylinder(edge);
        const SurfacePoint from = Snapper(surface)(on_cylinder(0.1, -100.0));
        ShortestPaths tree(surface, from);
        for (const double slip_ratio : {-0.2, 0.2}) {
            found.push_back(steered_errors(surface, tree, from, slip_ratio));
            std::printf("h %.0f, slip %.1f: length %.2e, angle %.2e rad\n", edge, slip_ratio,
                        found.back().length_share, found.back().angle_rad);
        }
    }
    for (const std::size_t i : {0U, 1U}) {
        EXPECT_LT(found[i + 2].length_share, 6e-4);
        EXPECT_LT(found[i + 2].angle_rad, 4e-3);
        EXPECT_GT(found[i].length_share / found[i + 2].length_share, std::exp2(1.3));
    }
}

// Where several geodesics join two points, the guess chooses: here one more turn either way.
TEST(Connect, GuessChoosesAmongSeveralGeodesics) {
    const Surface surface = cylinder(5.0);
    const Snapper snap(surface);
    constexpr double kTurn = 1.0;
    constexpr double kRun_mm = 200.0;
    const SurfacePoint from = snap(on_cylinder(0.0, -100.0));
    const SurfacePoint to = snap(on_cylinder(kTurn, -100.0 + kRun_mm));
    for (const double turn : {kTurn - 2.0 * kPi, kTurn, kTurn + 2.0 * kPi}) {
        const double around = kRadius_mm * turn;
        const double length = std::hypot(around, kRun_mm);
        // 0.05 rad and 2 % off.
        const double angle = std::atan2(around, kRun_mm) + 0.05;
        const ConnectResult result =
            connect(surface, from, to,
                    ConnectGuess{{0.0, std::sin(angle), std::cos(angle)}, 1.02 * length});
        expect_reached(surface, result, from, to);
        EXPECT_NEAR(result.length_mm, length, 5e-4 * length);  // h^2 / (24 R^2) = 4e-4
        EXPECT_EQ(result.polyhedral_mm, 0.0);
    }
}

// Great circle: R acos(a . b), and in the plane of both points and the centre.
TEST(Connect, SphereGreatCircle) {
    double last = 0.0;
    for (const double edge : {10.0, 5.0}) {
        const Surface surface = sphere(edge);
        std::mt19937_64 random(kSeed);
        const SurfacePoint from = test::random_start(surface, random).at;
        ShortestPaths tree(surface, from);
        double worst = 0.0;
        for (int i = 0; i < 20; ++i) {
            const SurfacePoint to = test::random_start(surface, random).at;
            const ConnectResult result = connect(surface, from, to, tree.to(to).value());
            expect_reached(surface, result, from, to);
            const Vector3d a = position_mm(surface, from).normalized();
            const Vector3d b = position_mm(surface, to).normalized();
            worst = std::max(worst, std::abs(result.length_mm - 100.0 * std::acos(a.dot(b))));
        }
        std::printf("great circles: h %.0f, worst length error %.4f mm\n", edge, worst);
        // Facets are inside by up to h^2 / (6 R) = 0.04 mm at h = 5, over lengths of up to pi R.
        EXPECT_LT(worst, kPi * edge * edge / 6.0 / 100.0);
        if (last > 0.0) {
            EXPECT_GT(last / worst, std::exp2(1.7));
        }
        last = worst;
    }
}

// Paths of constant slip on a sphere are circles of radius r = R / sqrt(1 + lambda^2): a chord c
// is bridged by an arc 2 r asin(c / (2 r)), and a point farther than 2 r by none.
TEST(Connect, SphereWithSlipReachesAsFarAsItsCircle) {
    const Surface surface = sphere(5.0);
    const Snapper snap(surface);
    constexpr double kSlip = 0.3;
    const double r = 100.0 / std::sqrt(1.0 + kSlip * kSlip);
    const SurfacePoint from = snap({0.0, 0.0, 100.0});
    ShortestPaths tree(surface, from);
    for (const double apart : {0.5, 1.5, 2.3}) {
        const SurfacePoint to = snap({100.0 * std::sin(apart), 0.0, 100.0 * std::cos(apart)});
        const ConnectResult result = connect(surface, from, to, tree.to(to).value(), kSlip);
        expect_reached(surface, result, from, to);
        const double arc = 2.0 * r * std::asin(100.0 * std::sin(0.5 * apart) / r);
        // Beside h^2 / (24 R^2) of the length, the radius is off with the fitted curvature.
        EXPECT_NEAR(result.length_mm, arc, 2e-3 * arc);
    }
    ASSERT_GT(200.0 * std::sin(0.5 * 2.9), 2.0 * r);
    const SurfacePoint far = snap({100.0 * std::sin(2.9), 0.0, 100.0 * std::cos(2.9)});
    const ConnectResult beyond = connect(surface, from, far, tree.to(far).value(), kSlip);
    EXPECT_EQ(beyond.stop, ConnectStop::Conjugate);
    EXPECT_NEAR(beyond.length_mm, kPi * r, 0.01 * kPi * r);  // half its circle
    EXPECT_LT(std::abs(beyond.jacobi_mm), 0.01 * beyond.length_mm);
    // From the far end of the circle to the target.
    const double reach = 2.0 * std::asin(r / 100.0);
    EXPECT_NEAR(beyond.miss_mm, 100.0 * (2.9 - reach), 2.0);
}

TEST(Connect, OppositePointsOnASphereAreConjugate) {
    const Surface surface = sphere(5.0);
    const Snapper snap(surface);
    const ConnectResult result =
        connect(surface, snap({0.0, 60.0, 80.0}), snap({0.0, -60.0, -80.0}));
    EXPECT_EQ(result.stop, ConnectStop::Conjugate);
    EXPECT_NEAR(result.length_mm, 100.0 * kPi, 0.3);
    EXPECT_LT(std::abs(result.jacobi_mm), 0.01 * result.length_mm);
    // All directions lead there, to within what the facets scatter.
    EXPECT_LT(result.miss_mm, 0.2);
}

TEST(Connect, WithinOneFacetIsAStraightLine) {
    const Surface surface = cylinder(10.0);
    const SurfacePoint from = test::point_in(100, 0.8, 0.1, 0.1);
    const SurfacePoint to = test::point_in(100, 0.2, 0.1, 0.7);
    const ConnectResult result = connect(surface, from, to);
    expect_reached(surface, result, from, to);
    const double straight = (position_mm(surface, to) - position_mm(surface, from)).norm();
    EXPECT_NEAR(result.length_mm, straight, 1e-9);
    EXPECT_NEAR(result.polyhedral_mm, straight, 1e-9);
}

// From a vertex and an edge to a vertex, where the way's first chord has no length.
TEST(Connect, TakesVerticesAndEdges) {
    const Surface surface = cylinder(10.0);
    const SurfacePoint to = test::point_in(900, 0.0, 1.0, 0.0);
    for (const SurfacePoint& from :
         {test::point_in(100, 1.0, 0.0, 0.0), test::point_in(100, 0.0, 0.5, 0.5)}) {
        expect_reached(surface, connect(surface, from, to), from, to);
    }
}

TEST(Connect, SamePointIsNamed) {
    const Surface surface = cylinder(10.0);
    const SurfacePoint at = test::point_in(100, 0.2, 0.1, 0.7);
    const ConnectResult result = connect(surface, at, at);
    EXPECT_EQ(result.stop, ConnectStop::SamePoint);
    EXPECT_TRUE(result.path.empty());
    EXPECT_EQ(result.length_mm, 0.0);
}

TEST(Connect, AnotherPieceIsUnreachable) {
    TriangleSoup soup = test::tube(10.0, 40.0, 24);
    const auto second = static_cast<std::int32_t>(soup.faces.size());
    test::add(soup, test::moved(test::tube(10.0, 40.0, 24),
                                Eigen::Isometry3d(Eigen::Translation3d(100.0, 0.0, 0.0))));
    const Surface surface = test::frozen(soup);
    const ConnectResult result = connect(surface, {.face = 3}, {.face = second + 3});
    EXPECT_EQ(result.stop, ConnectStop::Unreachable);
    EXPECT_TRUE(result.path.empty());
}

// A flat sheet with a rectangle cut out of one side: the shortest way bends around the cut, and no
// straight line joins the points.
TEST(Connect, RimBeforeTheTargetIsNamed) {
    TriangleSoup soup;
    constexpr std::int32_t kCells = 20;
    for (int j = 0; j <= kCells; ++j) {
        for (int i = 0; i <= kCells; ++i) {
            soup.points_mm.emplace_back(10.0 * i, 10.0 * j, 0.0);
        }
    }
    for (std::int32_t j = 0; j < kCells; ++j) {
        for (std::int32_t i = 0; i < kCells; ++i) {
            if (i >= 8 && i < 12 && j < 15) {
                continue;
            }
            const std::int32_t a = j * (kCells + 1) + i;
            soup.faces.push_back({a, a + 1, a + kCells + 1});
            soup.faces.push_back({a + 1, a + kCells + 2, a + kCells + 1});
        }
    }
    const Surface surface = test::frozen(soup);
    const Snapper snap(surface);
    const ConnectResult result = connect(surface, snap({31, 52, 0}), snap({168, 33, 0}));
    EXPECT_EQ(result.stop, ConnectStop::Rim) << name_of(result.stop);
    EXPECT_EQ(result.rim, 0);
    EXPECT_GT(result.miss_mm, 1.0);
    EXPECT_GT(result.polyhedral_mm, 137.0);
    // Over the cut there is a straight line.
    const ConnectResult over = connect(surface, snap({31, 172, 0}), snap({168, 183, 0}));
    ASSERT_EQ(over.stop, ConnectStop::Reached);
    EXPECT_NEAR(over.length_mm, std::hypot(137.0, 11.0), 1e-9);
}

TEST(Connect, TraceLimitsAreNamed) {
    const Surface surface = cylinder(10.0);
    const Snapper snap(surface);
    const SurfacePoint from = snap(on_cylinder(0.0, -100.0));
    const SurfacePoint to = snap(on_cylinder(1.0, 100.0));
    const ConnectResult shorter =
        connect(surface, from, to, 0.0, {.trace = {.max_length_mm = 80.0}});
    EXPECT_EQ(shorter.stop, ConnectStop::TraceLimit);
    EXPECT_EQ(shorter.length_mm, 80.0);
    EXPECT_NEAR(shorter.miss_mm, std::hypot(kRadius_mm, 200.0) - 80.0, 5.0);
    const ConnectResult fewer = connect(surface, from, to, 0.0, {.trace = {.max_faces = 10}});
    EXPECT_EQ(fewer.stop, ConnectStop::TraceLimit);
    EXPECT_LT(fewer.length_mm, 200.0);
    const ConnectResult tired = connect(surface, from, to, 0.2, {.max_iterations = 2});
    EXPECT_EQ(tired.stop, ConnectStop::Stalled);
    EXPECT_GT(tired.miss_mm, 1e-6);
}

// Top and bottom of a thin box: what is right under the target is not at it.
TEST(Connect, TellsTheSidesOfAThinWallApart) {
    const Surface surface = test::frozen(test::box({-50.0, -50.0, -0.5}, {50.0, 50.0, 0.5}));
    const Snapper snap(surface);
    const SurfacePoint from = snap({10.0, 3.0, 0.5});
    const SurfacePoint to = snap({20.0, 4.0, -0.5});
    const ConnectResult result = connect(surface, from, to);
    // Over the edge x = 50 the box unfolds to a plane.
    const double exact = std::hypot(40.0 + 1.0 + 30.0, 1.0);
    ASSERT_EQ(result.stop, ConnectStop::Reached) << name_of(result.stop);
    EXPECT_NEAR(result.length_mm, exact, 1e-6);
    EXPECT_LT(result.path.back().normal.z(), -0.99);
}

TEST(Connect, NamesEveryStop) {
    EXPECT_STREQ(name_of(ConnectStop::Reached), "reached");
    EXPECT_STREQ(name_of(ConnectStop::SamePoint), "same-point");
    EXPECT_STREQ(name_of(ConnectStop::Detour), "detour");
    EXPECT_STREQ(name_of(ConnectStop::Conjugate), "conjugate");
    EXPECT_STREQ(name_of(ConnectStop::Gap), "gap");
    EXPECT_STREQ(name_of(ConnectStop::Rim), "rim");
    EXPECT_STREQ(name_of(ConnectStop::TraceLimit), "trace-limit");
    EXPECT_STREQ(name_of(ConnectStop::Stalled), "stalled");
    EXPECT_STREQ(name_of(ConnectStop::Unreachable), "unreachable");
}

}  // namespace
}  // namespace meshwind
