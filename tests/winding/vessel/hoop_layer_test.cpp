#include "winding/vessel/hoop_layer.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace meshwind {
namespace {

// Along the axis the band covers width / sin(angle) around its centre.
double axial_half_mm(const HoopRequest& request, double pitch_mm) {
    const double around_mm = 2.0 * kPi * request.radius_mm;
    return 0.5 * request.band_mm * std::hypot(around_mm, pitch_mm) / around_mm;
}

// True when windings of `turns` turns between the edges leave no place bare: looked at along one
// line of the cylinder after the other, standing turns included.
bool covers(const HoopRequest& request, std::int64_t turns) {
    const double pitch_mm = (request.length_mm - request.band_mm) / static_cast<double>(turns);
    const double half_mm = axial_half_mm(request, pitch_mm);
    for (int line = 0; line < 16; ++line) {
        double covered_to_mm = request.band_mm;  // by the turn that stands at the first edge
        for (std::int64_t turn = 0; turn <= turns; ++turn) {
            const double centre_mm =
                0.5 * request.band_mm + pitch_mm * (static_cast<double>(turn) + line / 16.0);
            if (centre_mm > request.length_mm - 0.5 * request.band_mm + 1e-9) {
                continue;
            }
            if (centre_mm - half_mm > covered_to_mm + 1e-9) {
                return false;
            }
            covered_to_mm = std::max(covered_to_mm, centre_mm + half_mm);
        }
        if (covered_to_mm + 1e-9 < request.length_mm - request.band_mm) {
            return false;  // up to the turn that stands at the other edge
        }
    }
    return true;
}

TEST(HoopLayer, ClosesOverTheLengthInTheFewestTurnsThatCover) {
    for (int i = 0; i < 200; ++i) {
        const HoopRequest request{.radius_mm = 5.0 + i % 17,
                                  .length_mm = 40.0 + 3.7 * (i % 29),
                                  .band_mm = 3.0 + 1.3 * (i % 11),
                                  .passes = 1 + i % 4};
        const HoopLayer layer = hoop_layer(request);
        EXPECT_NEAR(layer.pitch_mm * static_cast<double>(layer.turns) + request.band_mm,
                    request.length_mm, 1e-12 * request.length_mm);
        EXPECT_NEAR(std::tan(layer.angle_rad), 2.0 * kPi * request.radius_mm / layer.pitch_mm,
                    1e-9);
        EXPECT_NEAR(layer.overlap,
                    2.0 * axial_half_mm(request, layer.pitch_mm) / layer.pitch_mm - 1.0, 1e-12);
        EXPECT_GE(layer.overlap, 0.0);
        EXPECT_TRUE(covers(request, layer.turns));
        if (layer.turns > 2) {
            EXPECT_FALSE(covers(request, layer.turns - 1)) << i;
        }
        EXPECT_EQ(layer.passes, request.passes);
        const double turns = static_cast<double>(layer.turns) * request.passes +
                             static_cast<double>(request.passes + 1);
        EXPECT_NEAR(layer.total_rad, 2.0 * kPi * turns, 1e-9);
    }
}

// 96 mm of travel in bands of 4 mm on a thick cylinder: 24 turns and no overlap but that of the
// slope, (4 / 628)^2 / 2.
TEST(HoopLayer, WholeNumbersOfBandsTakeNoTurnMore) {
    const HoopLayer layer = hoop_layer({.radius_mm = 100.0, .length_mm = 100.0, .band_mm = 4.0});
    EXPECT_EQ(layer.turns, 24);
    EXPECT_NEAR(layer.pitch_mm, 4.0, 1e-12);
    EXPECT_NEAR(layer.overlap, 0.5 * std::pow(4.0 / (200.0 * kPi), 2), 1e-9);
}

TEST(HoopLayer, KeepsTheOverlapOrGapWanted) {
    for (const double wanted : {-0.5, -0.1, 0.1, 0.5}) {
        const HoopRequest request{
            .radius_mm = 30.0, .length_mm = 250.0, .band_mm = 6.0, .least_overlap = wanted};
        const HoopLayer layer = hoop_layer(request);
        EXPECT_GE(layer.overlap, wanted - 1e-12);
        const double fewer_mm = 244.0 / static_cast<double>(layer.turns - 1);
        EXPECT_LT(2.0 * axial_half_mm(request, fewer_mm) / fewer_mm - 1.0, wanted);
    }
}

TEST(HoopLayer, RefusesWhatIsOutOfRange) {
    const HoopRequest good{.radius_mm = 30.0, .length_mm = 250.0, .band_mm = 6.0};
    const auto refused = [&](auto change) {
        HoopRequest request = good;
        change(request);
        try {
            (void)hoop_layer(request);
        } catch (const InputError& error) {
            return error.code() == "pattern.out_of_range";
        }
        return false;
    };
    EXPECT_FALSE(refused([](HoopRequest&) {}));
    for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
        EXPECT_TRUE(refused([&](HoopRequest& r) { r.radius_mm = bad; })) << bad;
        EXPECT_TRUE(refused([&](HoopRequest& r) { r.length_mm = bad; })) << bad;
        EXPECT_TRUE(refused([&](HoopRequest& r) { r.band_mm = bad; })) << bad;
    }
    EXPECT_TRUE(refused([](HoopRequest& r) { r.length_mm = r.band_mm; }));
    EXPECT_TRUE(refused([](HoopRequest& r) { r.passes = 0; }));
    EXPECT_TRUE(refused([](HoopRequest& r) { r.least_overlap = -1.0; }));
    EXPECT_TRUE(refused([](HoopRequest& r) { r.radius_mm = 0.9; }));
}

}  // namespace
}  // namespace meshwind
