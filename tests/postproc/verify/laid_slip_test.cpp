// Paths on a cylinder given in its unrolled plane, where the geodesic curvature is that of the
// plane curve.
#include "postproc/verify/laid_slip.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "core/units.h"

namespace meshwind {
namespace {

constexpr double kRadius_mm = 13.0;
constexpr double kLength_mm = 60.0;
constexpr int kStations = 601;
constexpr double kn_per_mm = 0.5 / kRadius_mm;  // at 45 degrees
constexpr LaidSlipOptions kOptions{.tow_width_mm = 2.0, .friction = 0.3, .aside_mm = 0.01};

// At 45 degrees to the axis, turned from it by an angle that is given along the way.
LaidPath laid(const std::function<double(double)>& turned_rad) {
    LaidPath laid;
    Eigen::Vector2d at = Eigen::Vector2d::Zero();  // along the girth, along the axis
    const double step = kLength_mm / (kStations - 1);
    for (int i = 0; i < kStations; ++i) {
        const double s = step * i;
        const auto way = [&](double where) {
            const double angle = 0.25 * kPi + turned_rad(where);
            return Eigen::Vector2d(std::sin(angle), std::cos(angle));
        };
        const double phi = at.x() / kRadius_mm;
        PathPoint point;
        point.normal = {std::cos(phi), std::sin(phi), 0.0};
        point.position_mm = {kRadius_mm * std::cos(phi), kRadius_mm * std::sin(phi), at.y()};
        point.tangent = way(s).x() * Eigen::Vector3d(-std::sin(phi), std::cos(phi), 0.0) +
                        way(s).y() * Eigen::Vector3d::UnitZ();
        point.s_mm = s;
        point.kn_per_mm = way(s).x() * way(s).x() / kRadius_mm;
        laid.path.push_back(point);
        laid.at.emplace_back();
        at += step / 6.0 * (way(s) + 4.0 * way(s + 0.5 * step) + way(s + step));
    }
    return laid;
}

Surface wall() {
    Surface surface;
    surface.mean_edge_mm = 0.5;
    return surface;
}

// Away from the ends, where chords are shorter.
double worst(const LaidPath& path, const LaidSlipOptions& options = kOptions) {
    const std::vector<double> slip = laid_slip(wall(), path, options);
    double worst = 0.0;
    for (std::size_t i = 0; i < slip.size(); ++i) {
        const double s_mm = path.path[i].s_mm;
        worst = s_mm > 10.0 && s_mm < kLength_mm - 10.0 ? std::max(worst, slip[i]) : worst;
    }
    return worst;
}

// A wave along the way that goes aside by this to either side.
LaidPath wave(double aside_mm, double length_mm) {
    const double k = 2.0 * kPi / length_mm;
    return laid([=](double s) { return aside_mm * k * std::cos(k * s); });
}

// Chords of twice 2 mm see the turn between the crests of a wave of 4 mm: 4 A / (2 mm)^2.
TEST(LaidSlip, CountsWhatLeadsAside) {
    const double ratio = 0.03 / kn_per_mm;
    EXPECT_NEAR(worst(wave(0.03, 4.0)), ratio, 0.05 * ratio);
}

// 0.39 over 2 mm: what is over the friction would move the fibre by 0.007 mm.
TEST(LaidSlip, DoesNotCountAWaveThatLeadsNowhere) {
    EXPECT_GT(worst(wave(0.015, 4.0), {.tow_width_mm = 2.0, .friction = 0.3, .aside_mm = 0.0}),
              0.37);
    EXPECT_LE(worst(wave(0.015, 4.0)), kOptions.friction);
}

// Hardly over the friction, but all along the way: chords of 8 mm tell.
TEST(LaidSlip, CountsWhatIsSteeredTooFarAllAlong) {
    // cot(angle) falls by slip / R per mm where kg = slip kn.
    const auto steered = [](double slip) {
        return worst(laid(
            [=](double s) { return std::atan2(1.0, 1.0 - slip * s / kRadius_mm) - 0.25 * kPi; }));
    };
    EXPECT_LE(steered(0.29), kOptions.friction);
    EXPECT_GT(steered(0.305), kOptions.friction);
    EXPECT_GT(steered(0.33), 0.32);
}

// A fibre that is lifted, or held by a pin, is not held by friction: nor within a tow width of it.
TEST(LaidSlip, LeavesOutBridgesAndPins) {
    LaidPath path = wave(0.03, 4.0);
    for (LaidAt& at : path.at) {
        at.held = true;
    }
    EXPECT_EQ(worst(path), 0.0);
}

}  // namespace
}  // namespace meshwind
