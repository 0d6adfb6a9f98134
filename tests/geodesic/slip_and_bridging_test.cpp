#include "geodesic/slip_and_bridging.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "mesh/shapes/make_kinds.h"
#include "tests/support/reference.h"
#include "tests/support/shapes.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// Stations on a circle in the plane y = 0, outside above: kn = -1 / radius in a valley.
SurfacePath arc(double radius_mm, double length_mm, int stations, double sign) {
    SurfacePath path;
    for (int i = 0; i < stations; ++i) {
        const double s = length_mm * i / (stations - 1);
        const double angle = s / radius_mm;
        PathPoint p;
        p.position_mm = {radius_mm * std::sin(angle), 0.0,
                         sign * radius_mm * (std::cos(angle) - 1.0)};
        p.tangent = {std::cos(angle), 0.0, -sign * std::sin(angle)};
        p.normal = {sign * std::sin(angle), 0.0, std::cos(angle)};
        p.s_mm = s;
        p.kn_per_mm = sign / radius_mm;
        path.push_back(p);
    }
    return path;
}

// A chord over a valley of radius r and angle theta is r (1 - cos(theta / 2)) high. The flat limit
// r theta^2 / 8 that is computed is too high by theta^2 / 48 of itself.
TEST(TautString, BridgesAConcaveArc) {
    constexpr double kRadius_mm = 150.0;
    for (const double theta : {0.1, 0.3, 1.0}) {
        const SurfacePath path = arc(kRadius_mm, kRadius_mm * theta, 101, -1.0);
        const TautString string = taut_string(path);
        EXPECT_EQ(string.worst_station, 50U);
        // The recursion is exact where kn is constant: rounding of 100 sums.
        EXPECT_NEAR(string.worst_gap_mm, kRadius_mm * theta * theta / 8.0, 1e-11);
        const double exact = kRadius_mm * (1.0 - std::cos(0.5 * theta));
        EXPECT_NEAR(string.worst_gap_mm, exact, 1.1 * exact * theta * theta / 48.0);
        EXPECT_EQ(string.gap_mm.front(), 0.0);
        EXPECT_EQ(string.gap_mm.back(), 0.0);
        // The string leaves the surface upward by theta / 2 and comes down to it again.
        EXPECT_NEAR(string.slope[1], 0.5 * theta, 0.02 * theta);
        EXPECT_NEAR(string.slope[50], 0.0, 1e-12);
        EXPECT_NEAR(string.slope[99], -0.5 * theta, 0.02 * theta);
    }
}

TEST(TautString, LiesOnAConvexArc) {
    const TautString string = taut_string(arc(50.0, 300.0, 201, 1.0));
    EXPECT_EQ(string.worst_gap_mm, 0.0);
    for (std::size_t i = 0; i < string.gap_mm.size(); ++i) {
        EXPECT_EQ(string.gap_mm[i], 0.0);
        EXPECT_EQ(string.slope[i], 0.0);
    }
}

// Convex before and after: the string leaves before the valley and touches down after it, which
// only makes it longer: at least the chord's height.
TEST(TautString, LeavesBeforeTheValley) {
    SurfacePath path = arc(100.0, 300.0, 301, 1.0);
    for (PathPoint& p : path) {
        p.kn_per_mm = (p.s_mm > 100.0 && p.s_mm < 200.0 ? -0.002 : 0.01);
    }
    const TautString string = taut_string(path);
    EXPECT_EQ(string.worst_station, 150U);
    // By symmetry the string is level at the middle and touches where the slope is: the valley
    // turns by 0.2, each hill gives back 0.1 over 10 mm; 0.002 50^2 / 2 + 0.1 10 - 0.01 10^2 / 2 =
    // 3 mm. Trapezoids across the two jumps of kn (0.012 over 1 mm) move it by up to 0.006 * 60 mm.
    EXPECT_NEAR(string.worst_gap_mm, 3.0, 0.36);
    EXPECT_EQ(string.gap_mm[80], 0.0);
    EXPECT_GT(string.gap_mm[95], 0.0);
    EXPECT_EQ(string.gap_mm[220], 0.0);
}

TEST(TautString, TakesShortPaths) {
    EXPECT_EQ(taut_string({}).worst_gap_mm, 0.0);
    EXPECT_EQ(taut_string(arc(50.0, 1.0, 2, -1.0)).worst_gap_mm, 0.0);
    const SurfacePath one(1, arc(50.0, 1.0, 2, 1.0)[0]);
    EXPECT_EQ(taut_string(one).gap_mm.size(), 1U);
}

// A trough of two planes that rise by `fold_rad` from each other, crease along y at x = 0.
Surface folded(double fold_rad) {
    constexpr std::int32_t kCells = 10;
    TriangleSoup soup;
    for (int j = 0; j <= kCells; ++j) {
        for (int i = -kCells; i <= kCells; ++i) {
            const double x = 5.0 * i;
            const double along = i < 0 ? 1.0 : std::cos(fold_rad);
            const double up = i < 0 ? 0.0 : std::sin(fold_rad);
            soup.points_mm.emplace_back(x * along, 5.0 * j, x * up);
        }
    }
    constexpr std::int32_t kRow = 2 * kCells + 1;
    for (std::int32_t j = 0; j < kCells; ++j) {
        for (std::int32_t i = 0; i + 1 < kRow; ++i) {
            const std::int32_t a = j * kRow + i;
            soup.faces.push_back({a, a + 1, a + kRow});
            soup.faces.push_back({a + 1, a + kRow + 1, a + kRow});
        }
    }
    return test::frozen(soup);
}

TraceResult across_fold(const Surface& surface) {
    // Cell (2, 5): from x = -38.5 straight along x.
    return trace(surface, test::point_in(2 * (5 * 20 + 2), 0.5, 0.3, 0.2), {1, 0, 0}, {},
                 {.max_length_mm = 60.0});
}

// Concave crease: slope jumps by sin(fold) and the string stands over it by sin(fold) a b / (a +
// b). The triangle's true height is by (a + b) / chord larger, at most 1 / cos(fold / 2).
TEST(TautString, BridgesAConcaveCrease) {
    const double fold = rad_from_deg(40.0);
    const Surface surface = folded(fold);
    const TraceResult traced = across_fold(surface);
    test::expect_sound(surface, traced, {.max_length_mm = 60.0});
    ASSERT_EQ(traced.stop, TraceStop::Length);
    const double a = -traced.path.front().position_mm.x();
    const double b = 60.0 - a;
    const TautString string = taut_string(traced.path);
    EXPECT_NEAR(string.worst_gap_mm, std::sin(fold) * a * b / 60.0, 1e-9);
    const Vector3d p = traced.path.front().position_mm;
    const Vector3d q = traced.path.back().position_mm;
    const Vector3d foot(0.0, p.y(), 0.0);
    const double exact = (foot - p).cross(q - p).norm() / (q - p).norm();
    EXPECT_LE(string.worst_gap_mm, exact + 1e-9);
    EXPECT_GE(string.worst_gap_mm, exact * std::cos(0.5 * fold) - 1e-9);
}

TEST(TautString, LiesOnAConvexCrease) {
    const Surface surface = folded(rad_from_deg(-40.0));
    EXPECT_LT(taut_string(across_fold(surface).path).worst_gap_mm, 1e-12);
}

// Over the valley of a torus' inner side: traced on triangles, compared with the chord in the plane
// of the inner equator. It is a geodesic by symmetry; nearby ones spread by exp(s sqrt(-K)), K =
// -1 / (50 150), which is 4.1 over 120 mm, and a normal's tilt of 4e-4 rad moves it by under 0.2
// mm.
TEST(TautString, BridgesTheInnerSideOfATorus) {
    constexpr double kInner_mm = 150.0;
    constexpr double kLength_mm = 120.0;
    double last = 0.0;
    for (const double h : {10.0, 5.0}) {
        const Surface surface =
            test::frozen(make_mandrel("torus", {}, {.edge_mm = h, .irregular = true}));
        SurfacePoint start;
        double least = 1e300;
        for (std::size_t f = 0; f < surface.face.size(); ++f) {
            const SurfacePoint centre{static_cast<std::int32_t>(f), Vector3d::Constant(1.0 / 3.0)};
            const Vector3d p = position_mm(surface, centre);
            const double off = (p - Vector3d(kInner_mm, 0, 0)).norm();
            if (off < least) {
                least = off;
                start = centre;
            }
        }
        const TraceResult traced =
            trace(surface, start, {0, 1, 0}, {}, {.max_length_mm = kLength_mm});
        const TautString string = taut_string(traced.path);
        const double flat = kLength_mm * kLength_mm / (8.0 * kInner_mm);
        std::printf("inner side of the torus, h %4.1f: gap %.4f mm, flat chord %.4f, exact %.4f\n",
                    h, string.worst_gap_mm, flat,
                    kInner_mm * (1.0 - std::cos(0.5 * kLength_mm / kInner_mm)));
        last = std::abs(string.worst_gap_mm / flat - 1.0);
    }
    EXPECT_LT(last, 0.005);  // measured 0.0013; h = 10: 0.006
}

struct SlipErrors {
    double mean = 0.0;  // of slip - commanded over the stations where the fibre is pressed on
    double rms = 0.0;
    double worst = 0.0;  // largest |slip - commanded|
};

// Stations whose ratio has a meaning: away from the ends, and pressed on.
SlipErrors slip_errors(const Surface& surface, const SurfacePath& path, double commanded,
                       TraceMethod method = TraceMethod::Walk) {
    const TautString string = taut_string(path);
    const SlipMeasure measure = measure_slip(surface, path, string, {.method = method});
    SlipErrors errors;
    double count = 0.0;
    double largest = 0.0;
    for (const PathPoint& p : path) {
        largest = std::max(largest, p.kn_per_mm);
    }
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (measure.error[i] > 0.05) {
            continue;
        }
        if (string.gap_mm[i] > 0.0 || path[i].kn_per_mm < 0.25 * largest) {
            continue;  // the ratio magnifies the scatter of kg by 1 / kn
        }
        const double off = measure.slip[i] - commanded;
        errors.mean += off;
        errors.rms += off * off;
        errors.worst = std::max(errors.worst, std::abs(off));
        count += 1.0;
    }
    errors.mean /= count;
    errors.rms = std::sqrt(errors.rms / count);
    return errors;
}

SurfacePath path_on(const Surface& surface, const Vector3d& near, const Vector3d& direction,
                    double slip, double length_mm, TraceMethod method = TraceMethod::Walk) {
    SurfacePoint start;
    double least = 1e300;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const SurfacePoint centre{static_cast<std::int32_t>(f), Vector3d::Constant(1.0 / 3.0)};
        const double off = (position_mm(surface, centre) - near).norm();
        if (off < least) {
            least = off;
            start = centre;
        }
    }
    return trace(surface, start, direction, {slip, 0.0},
                 {.max_length_mm = length_mm, .method = method})
        .path;
}

// The walk's positions scatter sideways, so its chords are long, and on a torus, where kn changes
// along them, the ratio of kg to a small kn is off by the chords' own third order. Rms measured at
// h = 5: under 0.005 on the cylinder, 0.020 on the torus; single stations up to 0.063. The ratio 0
// of geodesics comes out as this scatter.
TEST(MeasureSlip, FindsTheCommandedRatio) {
    for (const double h : {10.0, 5.0}) {
        const Surface cylinder = test::frozen(make_mandrel(
            "cylinder", {{"radius", 50.0}, {"length", 500.0}}, {.edge_mm = h, .irregular = true}));
        const Surface torus =
            test::frozen(make_mandrel("torus", {}, {.edge_mm = h, .irregular = true}));
        for (const double slip : {0.0, 0.2, -0.2}) {
            const SlipErrors c =
                slip_errors(cylinder, path_on(cylinder, {50, 0, -150}, {0, 0.9, 0.6}, slip, 300.0),
                            std::abs(slip));
            const SlipErrors t = slip_errors(
                torus, path_on(torus, {250, 0, 0}, {0, 0.6, 0.9}, slip, 250.0), std::abs(slip));
            std::printf(
                "slip %+.1f, h %4.1f: cylinder mean %+.4f rms %.4f worst %.4f, torus mean "
                "%+.4f rms %.4f worst %.4f\n",
                slip, h, c.mean, c.rms, c.worst, t.mean, t.rms, t.worst);
            if (h == 5.0) {
                EXPECT_LT(c.rms, 0.01);
                EXPECT_LT(t.rms, 0.025);
                EXPECT_LT(c.worst, 0.02);
                EXPECT_LT(t.worst, 0.08);
            }
        }
    }
}

// The same on patches: a lambda of 0.2 is measured within 0.002 everywhere at h = 5, on radii from
// 20 to 450 mm.
TEST(MeasureSlip, FindsTheCommandedRatioOnPatches) {
    for (const double slip : {0.0, 0.2, -0.2}) {
        const Surface torus =
            test::frozen(make_mandrel("torus", {}, {.edge_mm = 5.0, .irregular = true}));
        const SlipErrors t = slip_errors(
            torus, path_on(torus, {250, 0, 0}, {0, 0.6, 0.9}, slip, 250.0, TraceMethod::Patches),
            std::abs(slip), TraceMethod::Patches);
        std::printf("patches, slip %+.1f, torus: mean %+.5f rms %.5f worst %.5f\n", slip, t.mean,
                    t.rms, t.worst);
        EXPECT_LT(t.worst, 0.002);
        for (const double radius : {20.0, 70.0, 450.0}) {
            const Surface cylinder = test::frozen(make_mandrel(
                "cylinder", {{"radius", radius}, {"length", 500.0}},
                {.edge_mm = radius > 100.0 ? 10.0 : radius / 10.0, .irregular = true}));
            const SlipErrors c = slip_errors(cylinder,
                                             path_on(cylinder, {radius, 0, -150}, {0, 0.9, 0.6},
                                                     slip, 300.0, TraceMethod::Patches),
                                             std::abs(slip), TraceMethod::Patches);
            EXPECT_LT(c.worst, 0.002);
            std::printf("  cylinder of %.0f mm: mean %+.5f rms %.5f worst %.5f\n", radius, c.mean,
                        c.rms, c.worst);
        }
    }
}

// Positions, tangents, normals and kn are looked at: a lie about kg changes no bit.
TEST(MeasureSlip, IgnoresTheCommandedValue) {
    const Surface torus =
        test::frozen(make_mandrel("torus", {}, {.edge_mm = 10.0, .irregular = true}));
    SurfacePath path = path_on(torus, {250, 0, 0}, {0, 0.6, 0.9}, 0.2, 250.0);
    const TautString string = taut_string(path);
    const SlipMeasure honest = measure_slip(torus, path, string);
    for (PathPoint& p : path) {
        p.kg_per_mm = 99.0;
    }
    const SlipMeasure lied = measure_slip(torus, path, string);
    EXPECT_EQ(honest.slip, lied.slip);
    EXPECT_EQ(honest.kg_per_mm, lied.kg_per_mm);
    EXPECT_EQ(honest.worst_station, lied.worst_station);
}

// A circle of radius 20 in a plane is no geodesic and has nothing to hold it: kg = 1 / 20 is
// measured with the sign of its turn, and the slip ratio is far above any friction.
TEST(MeasureSlip, MeasuresTheTurnOnAPlane) {
    const Surface plane = folded(0.0);
    for (const double sign : {1.0, -1.0}) {
        SurfacePath path;
        for (int i = 0; i <= 200; ++i) {
            const double angle = 0.01 * i;
            PathPoint p;
            p.position_mm = {20.0 * std::sin(angle), sign * 20.0 * (1.0 - std::cos(angle)), 0.0};
            p.normal = Vector3d::UnitZ();
            p.tangent = {std::cos(angle), sign * std::sin(angle), 0.0};
            p.s_mm = 20.0 * angle;
            path.push_back(p);
        }
        const SlipMeasure measure =
            measure_slip(plane, path, taut_string(path), {.window_mm = 4.0});
        // Chords of a circle turn by exactly window / radius; linear interpolation takes off 1e-6.
        EXPECT_NEAR(measure.kg_per_mm[100], sign / 20.0, 1e-5);
        EXPECT_GT(measure.worst, 1.0);
    }
}

// Straight along a cylinder: nothing presses the fibre on and nothing needs to.
TEST(MeasureSlip, CountsAxialLinesAsStraight) {
    const Surface cylinder = test::frozen(make_mandrel(
        "cylinder", {{"radius", 50.0}, {"length", 500.0}}, {.edge_mm = 5.0, .irregular = true}));
    const SurfacePath path = path_on(cylinder, {50, 0, -200}, {0, 0, 1}, 0.0, 400.0);
    const SlipMeasure measure = measure_slip(cylinder, path, taut_string(path));
    std::printf("axial line: worst slip %.4f\n", measure.worst);
    EXPECT_LT(measure.worst, 0.2);
}

// Two planes that fall away from each other by 40 degrees, crossed askew. Unfolded the path is
// straight, so the string holds whatever the friction; a path that turns by 0.1 rad where it
// crosses is pressed on by the kink alone and slips by the ratio of both.
TEST(MeasureSlip, UnfoldsAConvexCrease) {
    const double fold = rad_from_deg(40.0);
    const Surface surface = folded(-fold);
    const Vector3d after(std::cos(fold), 0.0, -std::sin(fold));
    for (const double turn : {0.0, 0.1}) {
        SurfacePath path;
        for (int i = -60; i <= 60; ++i) {
            const bool beyond = i > 0;
            const double angle = rad_from_deg(30.0) + (beyond ? turn : 0.0);
            PathPoint p;
            p.s_mm = 0.5 * (i + 60);
            p.tangent = std::cos(angle) * (beyond ? after : Vector3d::UnitX()) +
                        std::sin(angle) * Vector3d::UnitY();
            p.normal = beyond ? Vector3d(std::sin(fold), 0.0, std::cos(fold)) : Vector3d::UnitZ();
            p.position_mm = 0.5 * i * p.tangent;
            path.push_back(p);
            if (i == 0) {  // the crossing is recorded once for each side
                p.tangent =
                    std::cos(angle + turn) * after + std::sin(angle + turn) * Vector3d::UnitY();
                p.normal = Vector3d(std::sin(fold), 0.0, std::cos(fold));
                path.push_back(p);
            }
        }
        const SlipMeasure measure =
            measure_slip(surface, path, taut_string(path), {.window_mm = 5.0});
        std::printf("crease, turned by %.1f: worst slip %.4f\n", turn, measure.worst);
        if (turn == 0.0) {
            EXPECT_LT(measure.worst, 1e-9);
        } else {
            // The slope of the string jumps by sin(fold) cos(angle), less than the angle itself.
            const double kink = std::sin(fold) * std::cos(rad_from_deg(30.0) + turn);
            EXPECT_NEAR(measure.worst, turn / kink, 0.03 * turn / kink);
        }
    }
}

TEST(MeasureSlip, TakesShortPaths) {
    const Surface plane = folded(0.0);
    EXPECT_EQ(measure_slip(plane, {}, {}).worst, 0.0);
    const SurfacePath path = arc(50.0, 1.0, 2, 1.0);
    EXPECT_EQ(measure_slip(plane, path, taut_string(path)).worst, 0.0);
}

}  // namespace
}  // namespace meshwind
