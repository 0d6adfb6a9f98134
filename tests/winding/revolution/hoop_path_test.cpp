#include "winding/revolution/hoop_path.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"

namespace meshwind {
namespace {

constexpr double kRounding = 1e-9;

Meridian flanged() {
    return Meridian({{.radius_mm = 30.0, .z_mm = -20.0, .straight = true},
                     {.radius_mm = 40.0, .z_mm = 0.0, .crease = true, .straight = true},
                     {.radius_mm = 40.0, .z_mm = 100.0, .crease = true, .straight = true},
                     {.radius_mm = 30.0, .z_mm = 120.0}});
}

TEST(HoopPath, FindsTheCylinder) {
    const Meridian meridian = flanged();
    const CylinderPart part = cylinder_at(meridian, meridian.widest_mm());
    EXPECT_NEAR(part.to_mm - part.from_mm, 100.0, kRounding);
    EXPECT_NEAR(part.radius_mm, 40.0, kRounding);
    const CylinderPart none = cylinder_at(meridian, 5.0);
    EXPECT_EQ(none.from_mm, none.to_mm);
}

// Rise and turns by what they are made of: two hoops, n turns of helix.
TEST(HoopPath, PlyWindsSideBySide) {
    const Meridian meridian = flanged();
    const CylinderPart part = cylinder_at(meridian, meridian.widest_mm());
    const double slip = 0.1;
    for (const double band : {6.0, 7.3, 25.0}) {
        const auto ply = hoop_ply(meridian, part, band, slip, 4.0);
        const double rise = 100.0 - band;
        const double turns = std::ceil(rise / band - kRounding);
        EXPECT_NEAR(ply.front().arc_mm - part.from_mm, 0.5 * band, kRounding);
        EXPECT_NEAR(part.to_mm - ply.back().arc_mm, 0.5 * band, kRounding);
        // No place is left out: a turn on, the path has risen by no more than a band.
        for (std::size_t i = 0; i < ply.size(); ++i) {
            for (std::size_t k = i; k < ply.size(); ++k) {
                if (ply[k].azimuth_rad >= ply[i].azimuth_rad + 2.0 * kPi) {
                    EXPECT_LE(ply[k].arc_mm - ply[i].arc_mm,
                              band + 4.0 * rise / turns / (2.0 * kPi * 40.0));
                    break;
                }
            }
        }
        // Steering adds some angle to two hoops and n turns, for there the path rises less.
        const double total = ply.back().azimuth_rad / (2.0 * kPi);
        EXPECT_GT(total, 2.0 + turns);
        EXPECT_LT(total, 2.0 + turns + 0.2);
        for (std::size_t i = 1; i < ply.size(); ++i) {
            const double ds = ply[i].s_mm - ply[i - 1].s_mm;
            EXPECT_GT(ds, 0.0);
            EXPECT_LE(ds, 4.0 + kRounding);
            // Steered no more than it may be: d(angle)/ds = slip sin(angle)^2 / R.
            EXPECT_LE(std::abs(ply[i].angle_rad - ply[i - 1].angle_rad),
                      slip / 40.0 * ds * (1.0 + kRounding));
            // And the chord of stations fits angle and distance.
            const double up = ply[i].arc_mm - ply[i - 1].arc_mm;
            const double round = 40.0 * (ply[i].azimuth_rad - ply[i - 1].azimuth_rad);
            EXPECT_NEAR(std::hypot(up, round), ds, 1e-3);
            EXPECT_NEAR(std::atan2(round, up), 0.5 * (ply[i].angle_rad + ply[i - 1].angle_rad),
                        1e-3);
        }
    }
}

TEST(HoopPath, ANarrowCylinderGetsOneTurn) {
    const Meridian meridian = flanged();
    const CylinderPart part = cylinder_at(meridian, meridian.widest_mm());
    const auto ply = hoop_ply(meridian, part, 120.0, 0.1, 4.0);
    EXPECT_NEAR(ply.back().azimuth_rad, 2.0 * kPi, kRounding);
    EXPECT_NEAR(ply.front().arc_mm, 0.5 * (part.from_mm + part.to_mm), kRounding);
}

TEST(HoopPath, TheNextPlyGoesDown) {
    const Meridian meridian = flanged();
    const CylinderPart part = cylinder_at(meridian, meridian.widest_mm());
    const auto up = hoop_ply(meridian, part, 6.0, 0.1, 4.0);
    const auto down = hoop_ply(meridian, part, 6.0, 0.1, 4.0, true);
    EXPECT_NEAR(down.front().arc_mm, up.back().arc_mm, kRounding);
    EXPECT_NEAR(down.back().arc_mm, up.front().arc_mm, kRounding);
    EXPECT_EQ(down.back().azimuth_rad, up.back().azimuth_rad);
    EXPECT_GT(down[down.size() / 2].angle_rad, 0.5 * kPi);
}

}  // namespace
}  // namespace meshwind
