#include "winding/plan/piece.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kSpacing_mm = 0.5;

// On the plane z = 0 along x, 60 mm: sideways it follows a sine of this height and length between
// 20 and 40 mm.
Piece wave(double height_mm, double length_mm) {
    Piece piece;
    for (int i = 0; i <= 120; ++i) {
        const double x = kSpacing_mm * i;
        const double phase = 2.0 * kPi * (x - 20.0) / length_mm;
        const bool waves = x >= 20.0 && x <= 40.0;
        const double slope = waves ? height_mm * std::sin(phase) : 0.0;
        PathPoint point;
        const double y =
            waves ? height_mm * length_mm / (2.0 * kPi) * (1.0 - std::cos(phase)) : 0.0;
        point.position_mm = {x, y, 0.0};
        point.tangent = Vector3d(1.0, slope, 0.0).normalized();
        point.normal = Vector3d::UnitZ();
        point.s_mm = piece.path.empty()
                         ? 0.0
                         : piece.path.back().s_mm +
                               (point.position_mm - piece.path.back().position_mm).norm();
        piece.path.push_back(point);
    }
    piece.slip.assign(piece.path.size(), 0.0);
    piece.string.gap_mm.assign(piece.path.size(), 0.0);
    piece.string.slope.assign(piece.path.size(), 0.0);
    return piece;
}

// Largest angle between the cubics of some stations and all that there were.
double turned_rad(const Piece& few, const Piece& all) {
    double most = 0.0;
    std::size_t k = 0;
    for (const PathPoint& here : all.path) {
        while (k + 2 < few.path.size() && few.path[k + 1].s_mm <= here.s_mm) {
            ++k;
        }
        const PathPoint& a = few.path[k];
        const PathPoint& b = few.path[k + 1];
        const Vector3d tangent =
            beside(a.position_mm, a.tangent, b.position_mm, b.tangent, here.position_mm).tangent;
        most = std::max(most, std::abs(std::asin(tangent.cross(here.tangent).z())));
    }
    return most;
}

TEST(ThinOut, KeepsStationsAsFarApartAsAskedWhereTheyTellThePath) {
    Piece piece = wave(0.0, 20.0);
    thin_out(piece, 4.0);
    EXPECT_EQ(piece.path.size(), 16U);  // 60 / 4 + 1
    EXPECT_EQ(piece.slip.size(), piece.path.size());
    EXPECT_EQ(piece.string.gap_mm.size(), piece.path.size());
}

TEST(ThinOut, KeepsMoreWhereTheCubicWouldTurnFromThePath) {
    const Piece all = wave(0.1, 5.0);
    Piece piece = all;
    thin_out(piece, 4.0);
    EXPECT_LT(turned_rad(piece, all), 1e-3);  // 5e-4 to each station left out, and their spacing
    EXPECT_GT(piece.path.size(), 24U);
    EXPECT_LT(piece.path.size(), all.path.size() / 2);  // none more where it is straight
}

}  // namespace
}  // namespace meshwind
