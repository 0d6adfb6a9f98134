/// What traces are compared with: fibre paths on exact surfaces, random starts, sound results.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/units.h"
#include "geodesic/trace.h"
#include "mesh/smooth/patch.h"
#include "tests/support/exact_torus.h"
#include "tests/support/frozen.h"

namespace meshwind::test {

struct CurveState {
    Eigen::Vector3d position_mm;
    Eigen::Vector3d tangent;
};

/// The fibre path on an exact surface with kg = slip_ratio kn: p' = t, t' = kg b - kn n by the
/// classical Runge-Kutta method. Steps of at most 0.25 mm leave (0.25 / 50)^4, 6e-10, of a mm per
/// mm on a tube of radius 50 mm.
template <class Shape>
CurveState follow(const Shape& shape, const CurveState& start, double length_mm,
                  double slip_ratio = 0.0) {
    using Eigen::Vector3d;
    const auto bend = [&](const Vector3d& p, const Vector3d& t) -> Vector3d {
        const Vector3d n = shape.normal(p);
        const double kn = t.dot(shape.shape_operator_per_mm(p) * t);
        return slip_ratio * kn * n.cross(t) - kn * n;
    };
    const int steps = static_cast<int>(std::ceil(length_mm / 0.25));
    const double h = length_mm / steps;
    Vector3d p = start.position_mm;
    Vector3d t = start.tangent;
    for (int i = 0; i < steps; ++i) {
        const Vector3d a = bend(p, t);
        const Vector3d tb = t + 0.5 * h * a;
        const Vector3d b = bend(p + 0.5 * h * t, tb);
        const Vector3d tc = t + 0.5 * h * b;
        const Vector3d c = bend(p + 0.5 * h * tb, tc);
        const Vector3d td = t + h * c;
        const Vector3d d = bend(p + h * tc, td);
        p += h / 6.0 * (t + 2.0 * tb + 2.0 * tc + td);
        t += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
        t.normalize();
    }
    return {p, t};
}

struct Start {
    SurfacePoint at;
    Eigen::Vector3d direction;  ///< unit, in the tangent plane
};

/// Anywhere on the surface in any direction.
inline Start random_start(const Surface& surface, std::mt19937_64& random) {
    std::uniform_int_distribution<std::int32_t> face(
        0, static_cast<std::int32_t>(surface.face.size()) - 1);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    Start start;
    start.at.face = face(random);
    double u = share(random);
    double v = share(random);
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    start.at.bary = {1.0 - u - v, u, v};
    const double angle = 2.0 * kPi * share(random);
    const Eigen::Vector3d n = smooth_normal(surface, start.at);
    const Eigen::Vector3d x = n.unitOrthogonal();
    start.direction = std::cos(angle) * x + std::sin(angle) * n.cross(x);
    return start;
}

/// The surface point whose patch point is `p_mm`, by Newton's method on each facet near it.
/// \pre the patches pass through `p_mm` within their own error
inline SurfacePoint patch_point(const Surface& surface, const Eigen::Vector3d& p_mm) {
    SurfacePoint best;
    double least_mm = 1e300;
    for (std::size_t f = 0; f < surface.face.size(); ++f) {
        const auto face = static_cast<std::int32_t>(f);
        if ((position_mm(surface, {face}) - p_mm).norm() > 2.0 * surface.mean_edge_mm) {
            continue;
        }
        const Patch patch(surface, face);
        Eigen::Vector2d uv = Eigen::Vector2d::Constant(1.0 / 3.0);
        for (int i = 0; i < 8; ++i) {
            const PatchPlace place = patch.at(uv);
            Eigen::Matrix3d basis;
            basis << place.along_u, place.along_v, place.normal();
            uv += basis.inverse().topRows<2>() * (p_mm - place.position_mm);
        }
        const Eigen::Vector3d bary(1.0 - uv.sum(), uv.x(), uv.y());
        const double off_mm = (patch.at(uv).position_mm - p_mm).norm();
        if (bary.minCoeff() >= 0.0 && off_mm < least_mm) {
            least_mm = off_mm;
            best = {face, bary};
        }
    }
    EXPECT_LT(least_mm, 1e-3 * surface.mean_edge_mm);
    return best;
}

/// What holds for every trace, whatever the surface: finite, ordered, unit, tangential, in its
/// face.
inline void expect_sound(const Surface& surface, const TraceResult& result,
                         const TraceOptions& options = {}) {
    ASSERT_FALSE(result.path.empty());
    double last_s = 0.0;
    for (const PathPoint& p : result.path) {
        ASSERT_TRUE(p.position_mm.allFinite() && p.normal.allFinite() && p.tangent.allFinite());
        ASSERT_TRUE(std::isfinite(p.kn_per_mm) && std::isfinite(p.kg_per_mm));
        ASSERT_GE(p.s_mm, last_s);
        last_s = p.s_mm;
        // Rounding of one normalisation and one projection.
        ASSERT_NEAR(p.normal.norm(), 1.0, 1e-14);
        ASSERT_NEAR(p.tangent.norm(), 1.0, 1e-14);
        ASSERT_NEAR(p.normal.dot(p.tangent), 0.0, 1e-14);
        ASSERT_TRUE(p.at.face >= 0 && static_cast<std::size_t>(p.at.face) < surface.face.size());
        ASSERT_NEAR(p.at.bary.sum(), 1.0, 1e-14);
        ASSERT_GE(p.at.bary.minCoeff(), 0.0);
        // Rounding of coordinates of up to 1000 mm, three products; on a patch of its height too.
        const Eigen::Vector3d there = options.method == TraceMethod::Walk
                                          ? position_mm(surface, p.at)
                                          : on_patch(surface, p.at.face, p.at.bary).position_mm;
        ASSERT_LT((there - p.position_mm).norm(), 1e-12 * 1000.0);
    }
    ASSERT_LE(last_s, options.max_length_mm);
    if (result.stop == TraceStop::Length) {
        ASSERT_EQ(last_s, options.max_length_mm);
    }
    ASSERT_EQ(result.stop == TraceStop::Rim, result.rim >= 0);
}

/// Tests of what holds for both methods: trace() is that of the parameter.
class BothTracers : public testing::TestWithParam<TraceMethod> {
protected:
    static TraceOptions with_method(TraceOptions options) {
        options.method = GetParam();
        return options;
    }
    static TraceResult trace(const Surface& surface, const SurfacePoint& start,
                             const Eigen::Vector3d& direction, const Steering& steering = {},
                             const TraceOptions& options = {}) {
        return meshwind::trace(surface, start, direction, steering, with_method(options));
    }
    static void expect_sound(const Surface& surface, const TraceResult& result,
                             const TraceOptions& options = {}) {
        test::expect_sound(surface, result, with_method(options));
    }
};

inline std::string method_name(const testing::TestParamInfo<TraceMethod>& info) {
    return info.param == TraceMethod::Walk ? "Walk" : "Patches";
}

/// The vertex, edge or inner point of a face: corner shares by name.
inline SurfacePoint point_in(std::int32_t face, double a, double b, double c) {
    return {face, Eigen::Vector3d(a, b, c)};
}

}  // namespace meshwind::test
