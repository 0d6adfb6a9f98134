#include "winding/turn/pin_turn.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

Pin standing_pin() {
    Pin pin;
    pin.axis = Vector3d::UnitZ();
    pin.base_mm = Vector3d(10.0, 5.0, 0.0);
    pin.radius_mm = 1.5;
    pin.height_mm = 6.0;
    pin.strand_mm = 0.5;
    return pin;
}

// A quarter about a circle of 2 mm between two tangents of 10 mm, level.
TEST(PinString, QuarterTurnHasTangentsAndArc) {
    const Pin pin = standing_pin();
    const Vector3d from(8.0, -5.0, 1.0);
    const Vector3d to(20.0, 7.0, 1.0);
    const PinString string = string_about(pin, PinSide::Right, from, to);
    EXPECT_NEAR(string.bend_rad, 0.5 * kPi, 1e-12);
    EXPECT_NEAR(string.length_mm, 20.0 + kPi, 1e-12);
    EXPECT_NEAR(string.to_out_mm, 10.0 + kPi, 1e-12);
    EXPECT_NEAR((string.out_mm - Vector3d(10.0, 7.0, 1.0)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((string.direction - Vector3d::UnitY()).norm(), 0.0, 1e-12);
    EXPECT_FALSE(string.on_pin);
}

// Unrolled from the pin a rising string is straight: its height is even over its length.
TEST(PinString, RisesEvenly) {
    const Pin pin = standing_pin();
    const PinString string =
        string_about(pin, PinSide::Right, Vector3d(8.0, -5.0, 0.0), Vector3d(20.0, 7.0, 3.0));
    const double level = 20.0 + kPi;
    EXPECT_NEAR(string.length_mm, std::hypot(level, 3.0), 1e-12);
    EXPECT_NEAR(string.out_mm.z(), 3.0 * (10.0 + kPi) / level, 1e-12);
    EXPECT_NEAR(string.top_mm, string.out_mm.z(), 1e-12);
}

TEST(PinString, MirroredPlacesMirrorIt) {
    const Pin pin = standing_pin();
    const PinString right =
        string_about(pin, PinSide::Right, Vector3d(8.0, -5.0, 0.0), Vector3d(20.0, 8.0, 3.0));
    const PinString left =
        string_about(pin, PinSide::Left, Vector3d(12.0, -5.0, 0.0), Vector3d(0.0, 8.0, 3.0));
    EXPECT_NEAR(right.bend_rad, left.bend_rad, 1e-12);
    EXPECT_NEAR(right.length_mm, left.length_mm, 1e-12);
    EXPECT_NEAR(right.out_mm.x() - 10.0, 10.0 - left.out_mm.x(), 1e-12);
}

// No other way about the pin is shorter: leaving it further on, higher or lower. Before the tangent
// the way would lead through the pin.
TEST(PinString, IsTheShortest) {
    const Pin pin = standing_pin();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 50; ++i) {
        const Vector3d from(6.0 + unit(random), -6.0 + unit(random), unit(random));
        const Vector3d to(22.0 + unit(random), 6.0 + unit(random), 3.0 + unit(random));
        const PinString string = string_about(pin, PinSide::Right, from, to);
        const double angle = std::atan2(string.out_mm.y() - 5.0, string.out_mm.x() - 10.0);
        for (const double turned : {-0.02, 0.0}) {
            for (const double up : {-0.05, 0.0, 0.05}) {
                const Vector3d out(10.0 + 2.0 * std::cos(angle + turned),
                                   5.0 + 2.0 * std::sin(angle + turned), string.out_mm.z() + up);
                const PinString before = string_about(pin, PinSide::Right, from, out);
                EXPECT_GT(before.length_mm + (to - out).norm(), string.length_mm - 1e-9);
            }
        }
    }
}

TEST(SideTouched, TellsSideHeightAndPlace) {
    const Pin pin = standing_pin();
    const Vector3d from(0.0, 6.0, 1.0);
    EXPECT_EQ(side_touched(pin, from, Vector3d(20.0, 6.0, 1.0)), PinSide::Right);
    EXPECT_EQ(side_touched(pin, from, Vector3d(20.0, 2.0, 1.0)), PinSide::Left);
    EXPECT_FALSE(side_touched(pin, from, Vector3d(20.0, 10.0, 1.0)));  // beside
    EXPECT_FALSE(side_touched(pin, from, Vector3d(20.0, 6.0, 15.0)));  // over its top
    EXPECT_FALSE(side_touched(pin, from, Vector3d(5.0, 6.0, 1.0)));    // before it
    EXPECT_FALSE(side_touched(pin, from, Vector3d(-20.0, 6.0, 1.0)));  // behind
}

PinTurnShape small_shape() {
    return {.radius_mm = 40.0,
            .angle_rad = rad_from_deg(20.0),
            .held_mm = 1.7,
            .offset_mm = 9.0,
            .pitch_mm = 2.0 * kPi,
            .skip = 6,
            .lead_mm = 17.0,
            .diameter_mm = 2.0};
}

Rim upper_rim() {
    Rim rim;
    rim.id = 0;
    rim.radius_mm = 40.0;
    return rim;
}

// The closed forms against the stations, which are sums of their own.
TEST(PinTurn, ClosedFormsAreThoseOfTheStations) {
    const PinTurnShape shape = small_shape();
    const Rim rim = upper_rim();
    for (const int sense : {1, -1}) {
        const RimCrossing from{0, 0.4, shape.angle_rad, sense};
        const LaidTurn turn = turn_on_pins(rim, from, shape, 6.0);
        const SurfacePath& path = turn.piece.path;
        EXPECT_NEAR(path.back().s_mm, pin_turn_length_mm(shape), 1e-9);
        const RimCrossing to = crossing_at(rim, path.back().position_mm, -path.back().tangent);
        EXPECT_NEAR(to.angle_rad, shape.angle_rad, 1e-12);
        EXPECT_EQ(to.sense, -sense);
        EXPECT_NEAR(std::remainder(sense * (to.azimuth_rad - from.azimuth_rad) -
                                       pin_turn_around_mm(shape) / rim.radius_mm,
                                   2.0 * kPi),
                    0.0, 1e-12);
        double chords = 0.0;
        for (std::size_t i = 1; i < path.size(); ++i) {
            chords += (path[i].position_mm - path[i - 1].position_mm).norm();
        }
        EXPECT_NEAR(chords, path.back().s_mm, 0.02);  // s^3 / (24 R^2) a chord
    }
}

// Both bends are about pins of the ring: on the unrolled wall nowhere nearer than held_mm.
TEST(PinTurn, BendsAboutPinsOfItsRing) {
    const PinTurnShape shape = small_shape();
    const Rim rim = upper_rim();
    const RimCrossing from{0, 0.4, shape.angle_rad, 1};
    const PinRing ring = ring_for(rim, from, shape);
    EXPECT_EQ(ring.count, 40);
    const LaidTurn turn = turn_on_pins(rim, from, shape, 6.0);
    std::vector<double> nearest(40, 1e9);
    for (const PathPoint& point : turn.piece.path) {
        const Vector3d x = rim_reference(rim);
        const double azimuth =
            std::atan2(point.position_mm.dot(rim.axis.cross(x)), point.position_mm.dot(x));
        for (std::size_t i = 0; i < 40; ++i) {
            const double off = std::remainder(
                azimuth - ring.azimuth_rad - 2.0 * kPi * static_cast<double>(i) / 40.0, 2.0 * kPi);
            nearest[i] = std::min(nearest[i],
                                  std::hypot(40.0 * off, point.position_mm.z() - shape.offset_mm));
        }
    }
    int touched = 0;
    for (const double mm : nearest) {
        EXPECT_GT(mm, shape.held_mm - 1e-9);
        touched += mm < shape.held_mm + 0.5 ? 1 : 0;  // stations on the hoop are 2 mm apart
    }
    EXPECT_EQ(touched, shape.skip + 1);
}

// Where the free fibre begins it never jumps, and beyond the turn it is the station again.
TEST(PinTurn, FreeFibreBeginsWithoutJumps) {
    const LaidTurn turn =
        turn_on_pins(upper_rim(), {0, 0.4, rad_from_deg(20.0), 1}, small_shape(), 6.0);
    const std::vector<FreeStart>& starts = turn.piece.free_start;
    ASSERT_EQ(starts.size(), turn.piece.path.size());
    for (std::size_t i = 1; i < starts.size(); ++i) {
        const Vector3d eye = starts[i].from_mm + 200.0 * starts[i].direction;
        const Vector3d before = starts[i - 1].from_mm + 200.0 * starts[i - 1].direction;
        EXPECT_LT((eye - before).norm(), 12.0) << i;  // 2.5 degrees at 200 mm are 8.7 mm
    }
    EXPECT_EQ(starts.back().from_mm, turn.piece.path.back().position_mm);
    EXPECT_EQ(starts.front().from_mm, turn.piece.path.front().position_mm);
}

// The hoop's tangent passes below the top of the pin that holds and above that of the next.
TEST(FitPins, LeadPutsTheFibreBetweenTwoPinsTops) {
    PinTurnShape shape = small_shape();
    const PinFit fit = fit_pins(shape, 0.7, std::nullopt);
    ASSERT_EQ(fit.failure, "");
    const auto over_wall = [&](double ahead) {
        return shape.radius_mm / std::cos(ahead / shape.radius_mm) - shape.radius_mm;
    };
    EXPECT_LT(over_wall(fit.lead_mm) + 0.7, fit.height_mm);
    EXPECT_GT(over_wall(fit.lead_mm + shape.pitch_mm - 1.0), fit.height_mm + 0.7);
    EXPECT_GE(fit.least_skip * shape.pitch_mm, 2.0 * fit.lead_mm);
}

TEST(FitPins, SaysWhatIsTooNarrow) {
    PinTurnShape shape = small_shape();
    shape.pitch_mm = 3.0;
    // Pins of 2 mm with a strand of 0.7 mm to either side take 3.4 mm.
    EXPECT_NE(fit_pins(shape, 0.7, std::nullopt).failure, "");
    shape.pitch_mm = 2.0 * kPi;
    EXPECT_TRUE(test::tells(fit_pins(shape, 0.7, 0.5).failure, "0.20 mm"));
}

}  // namespace
}  // namespace meshwind
