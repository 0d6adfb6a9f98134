#include "winding/turn/course_turns.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "winding/turn/pin.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 50.0;
constexpr Tow kTow{.width_mm = 10.0, .thickness_mm = 0.25};

std::vector<Rim> one_rim() {
    Rim rim;
    rim.id = 0;
    rim.radius_mm = kRadius_mm;
    return {rim};
}

CourseTurns on_pins(const std::vector<Rim>& rims) {
    std::string failure;
    CourseTurns turns{{.friction = 0.3, .extension_mm = 40.0, .band_mm = kTow.width_mm}};
    turns.pins = stand_pins(rims, {}, kTow, 40.0, failure);
    EXPECT_EQ(failure, "");
    return turns;
}

// Moved to where a pin takes hold of it.
RimCrossing at_a_pin(const Rim& rim, RimCrossing crossing, const CourseTurns& turns) {
    crossing.azimuth_rad += crossing.sense * off_pins_mm(rim, crossing, turns) / rim.radius_mm;
    return crossing;
}

// Random courses, moved to their pins: the turn leads from one to the other, as long as it is said
// to be, bends about the flanks of two pins and cuts none by more than it presses on them.
TEST(CourseTurns, LeadFromCourseToCourseAboutPins) {
    const std::vector<Rim> rims = one_rim();
    const Rim& rim = rims.front();
    const CourseTurns turns = on_pins(rims);
    const PinStand& stand = turns.pins.front();
    const std::vector<Pin> pins = pins_of(stand.ring, rim);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> angle(0.05, stand.widest_rad);
    std::uniform_real_distribution<double> azimuth(-kPi, kPi);
    for (int i = 0; i < 40; ++i) {
        const int sense = i % 2 == 0 ? 1 : -1;
        const RimCrossing from = at_a_pin(rim, {0, azimuth(random), angle(random), sense}, turns);
        const RimCrossing to = at_a_pin(rim, {0, azimuth(random), angle(random), -sense}, turns);
        const LaidTurn turn = turn_between(rim, from, to, turns, 4.0);
        const SurfacePath& path = turn.piece.path;
        EXPECT_NEAR(path.back().s_mm, turn_mm(rim, from, to, turns), 1e-9);
        const RimCrossing begins = crossing_at(rim, path.front().position_mm, path.front().tangent);
        const RimCrossing ends = crossing_at(rim, path.back().position_mm, -path.back().tangent);
        for (const auto& [is, meant] : {std::pair{begins, from}, std::pair{ends, to}}) {
            EXPECT_NEAR(std::remainder(is.azimuth_rad - meant.azimuth_rad, 2.0 * kPi), 0.0, 1e-9);
            EXPECT_NEAR(is.angle_rad, meant.angle_rad, 1e-9);
        }
        double nearest = std::numeric_limits<double>::infinity();
        for (const PathPoint& station : path) {
            for (const Pin& pin : pins) {
                nearest = std::min(nearest, (station.position_mm - pin.base_mm).norm());
            }
        }
        EXPECT_LT(nearest, stand.shape.held_mm);
        EXPECT_GT(nearest, stand.shape.held_mm - 0.06);
    }
}

TEST(CourseTurns, OffPinsIsLinearInAzimuthAndHasItsSlopeInTheAngle) {
    const std::vector<Rim> rims = one_rim();
    const Rim& rim = rims.front();
    const CourseTurns turns = on_pins(rims);
    const double pitch_mm = turns.pins.front().shape.pitch_mm;
    for (const int sense : {1, -1}) {
        const RimCrossing end{0, 0.3, 0.6, sense};
        const double off_mm = off_pins_mm(rim, end, turns);
        RimCrossing moved = end;
        moved.azimuth_rad += sense * 0.7 / kRadius_mm;
        EXPECT_NEAR(std::remainder(off_pins_mm(rim, moved, turns) - off_mm + 0.7, pitch_mm), 0.0,
                    1e-9);
        moved = end;
        moved.angle_rad += 1e-5;
        EXPECT_NEAR((off_pins_mm(rim, moved, turns) - off_mm) / 1e-5,
                    off_pins_mm_per_rad(rim, end, turns), 1e-2);
        EXPECT_NEAR(off_pins_mm(rim, at_a_pin(rim, end, turns), turns), 0.0, 1e-9);
    }
}

// The halves that a course needs by itself, one after the other, are a turn of least length.
TEST(CourseTurns, HalvesMakeAWhole) {
    const std::vector<Rim> rims = one_rim();
    const Rim& rim = rims.front();
    const CourseTurns turns = on_pins(rims);
    const RimCrossing end{0, 1.1, 0.7, 1};
    const Piece from = half_turn_from(rim, end, turns, 4.0);
    RimCrossing start = end;
    start.sense = -1;
    const Piece to = half_turn_to(rim, start, turns, 4.0);
    const double whole_mm = from.path.back().s_mm + to.path.back().s_mm;
    EXPECT_NEAR(whole_mm, 2.0 * half_turn_mm(rim, end, turns), 1e-9);
    const RimCrossing begins =
        crossing_at(rim, from.path.front().position_mm, from.path.front().tangent);
    const RimCrossing ends = crossing_at(rim, to.path.back().position_mm, -to.path.back().tangent);
    EXPECT_NEAR(begins.azimuth_rad, end.azimuth_rad, 1e-9);
    EXPECT_NEAR(ends.azimuth_rad, start.azimuth_rad, 1e-9);
    EXPECT_EQ(from.path.size(), from.free_start.size());
    EXPECT_EQ(to.path.size(), to.free_start.size());
}

TEST(CourseTurns, WideFibreDoesNotPassBetweenPins) {
    const std::vector<Rim> rims = one_rim();
    const Rim& rim = rims.front();
    const CourseTurns turns = on_pins(rims);
    EXPECT_TRUE(can_turn(rim, {0, 0.0, 0.0, 1}, turns));  // along the axis no friction would do
    EXPECT_FALSE(can_turn(rim, {0, 0.0, 0.0, 1}, CourseTurns{turns.rule}));
    EXPECT_TRUE(can_turn(rim, {0, 0.0, turns.pins.front().widest_rad, 1}, turns));
    EXPECT_FALSE(can_turn(rim, {0, 0.0, rad_from_deg(85.0), 1}, turns));
}

TEST(CourseTurns, PinsThatDoNotFitAreRefusedWithTheRim) {
    std::string failure;
    EXPECT_TRUE(stand_pins(one_rim(), {}, kTow, 10.0, failure).empty());
    EXPECT_NE(failure.find("rim 0: the turn on pins takes"), std::string::npos) << failure;
    failure.clear();
    EXPECT_TRUE(stand_pins(one_rim(), {.count = 200}, kTow, 40.0, failure).empty());
    EXPECT_NE(failure.find("leave no gap"), std::string::npos) << failure;
}

// Of a narrow tow pins at its own pitch leave no room between each other: they stand farther apart.
TEST(CourseTurns, StandFartherApartForNarrowTows) {
    const std::vector<Rim> rims = one_rim();
    for (const double width_mm : {2.0, 3.0, 6.0, 10.0, 20.0}) {
        std::string failure;
        const auto stands =
            stand_pins(rims, {}, {.width_mm = width_mm, .thickness_mm = 0.25}, 60.0, failure);
        ASSERT_EQ(failure, "") << width_mm;
        EXPECT_GE(stands.front().widest_rad, 55.0 * kPi / 180.0) << width_mm;
    }
}

}  // namespace
}  // namespace meshwind
