#include "winding/turn/turn.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/text/text_number.h"
#include "core/units.h"
#include "tests/support/fixtures.h"
#include "tests/support/tells.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr double kStep_mm = 0.25;
constexpr TurnRule kRule{.friction = 0.25, .extension_mm = 120.0, .band_mm = 8.0};

Rim slanted_rim() {
    Rim rim;
    rim.id = 3;
    rim.centre_mm = Vector3d(12.0, -5.0, 30.0);
    rim.axis = Vector3d(1.0, 2.0, 2.0) / 3.0;
    rim.radius_mm = 40.0;
    return rim;
}

RimCrossing crossing(double azimuth_deg, double angle_deg, int sense) {
    return {3, rad_from_deg(azimuth_deg), rad_from_deg(angle_deg), sense};
}

Vector3d radial_at(const Rim& rim, double azimuth) {
    const Vector3d x = rim_reference(rim);
    return std::cos(azimuth) * x + std::sin(azimuth) * rim.axis.cross(x);
}

Vector3d outward_at(const Rim& rim, const RimCrossing& c) {
    const Vector3d around = rim.axis.cross(radial_at(rim, c.azimuth_rad));
    return std::cos(c.angle_rad) * rim.axis + std::sin(c.angle_rad) * c.sense * around;
}

// Azimuth and height of a station on the extension's cylinder.
struct Unrolled {
    double azimuth = 0.0;
    double height_mm = 0.0;
};

Unrolled unrolled(const Rim& rim, const Vector3d& position) {
    const Vector3d d = position - rim.centre_mm;
    const Vector3d x = rim_reference(rim);
    return {std::atan2(d.dot(rim.axis.cross(x)), d.dot(x)), d.dot(rim.axis)};
}

// Difference of two angles, within half a turn.
double difference(double a, double b) {
    return std::remainder(a - b, 2.0 * kPi);
}

// Geodesic curvature, to the left of travel, of the middle of three stations: the cylinder is
// developable, so it is the curvature of the circle through the three unrolled points.
double measured_kg(const Rim& rim, const SurfacePath& path, std::size_t i) {
    const Unrolled before = unrolled(rim, path[i - 1].position_mm);
    const Unrolled here = unrolled(rim, path[i].position_mm);
    const Unrolled after = unrolled(rim, path[i + 1].position_mm);
    const Eigen::Vector2d in(rim.radius_mm * difference(here.azimuth, before.azimuth),
                             here.height_mm - before.height_mm);
    const Eigen::Vector2d out(rim.radius_mm * difference(after.azimuth, here.azimuth),
                              after.height_mm - here.height_mm);
    // Seen from outside with the axis up, counter-clockwise is to the right.
    return 2.0 * (in.x() * out.y() - in.y() * out.x()) /
           (in.norm() * out.norm() * (in + out).norm());
}

struct Case {
    RimCrossing from;
    RimCrossing to;
};

std::vector<Case> cases() {
    std::vector<Case> all{{crossing(0, 60, 1), crossing(90, 60, -1)},
                          {crossing(170, 45, -1), crossing(-170, 84, 1)},
                          {crossing(-90, 83, 1), crossing(-90, 50, -1)}};
    test::Draw draw(7);
    while (all.size() < 40) {
        const int sense = draw.coin() ? 1 : -1;
        all.push_back({crossing(draw.between(-180, 180), draw.between(42, 84), sense),
                       crossing(draw.between(-180, 180), draw.between(42, 84), -sense)});
    }
    return all;
}

TEST(CrossingAt, GivesBackWhatItWasBuiltFrom) {
    const Rim rim = slanted_rim();
    for (const Case& c : cases()) {
        const Vector3d position =
            rim.centre_mm + rim.radius_mm * radial_at(rim, c.from.azimuth_rad);
        const RimCrossing found = crossing_at(rim, position, outward_at(rim, c.from));
        EXPECT_EQ(found.rim, rim.id);
        EXPECT_NEAR(difference(found.azimuth_rad, c.from.azimuth_rad), 0.0, 1e-12);
        EXPECT_NEAR(found.angle_rad, c.from.angle_rad, 1e-12);
        EXPECT_EQ(found.sense, c.from.sense);
    }
}

// The wall meets its extension in a crease, and unfolding keeps the angle to that.
TEST(CrossingAt, LeaningWallsKeepTheAngleToTheRim) {
    const Rim rim = slanted_rim();
    const RimCrossing built = crossing(30.0, 55.0, 1);
    const Vector3d radial = radial_at(rim, built.azimuth_rad);
    const Vector3d position = rim.centre_mm + rim.radius_mm * radial;
    for (const double lean_deg : {-30.0, 8.5, 45.0}) {
        const double lean = rad_from_deg(lean_deg);
        const Vector3d up = std::cos(lean) * rim.axis + std::sin(lean) * radial;
        const Vector3d outward =
            std::cos(built.angle_rad) * up + std::sin(built.angle_rad) * rim.axis.cross(radial);
        const RimCrossing found = crossing_at(rim, position, outward);
        EXPECT_NEAR(found.angle_rad, built.angle_rad, 1e-12) << lean_deg;
        EXPECT_EQ(found.sense, 1);
    }
}

TEST(TurnRun, IsTheClosedForm) {
    EXPECT_NEAR(turn_run_mm(50.0, rad_from_deg(30.0), 0.2), 250.0, 1e-9);
    EXPECT_NEAR(turn_run_mm(40.0, rad_from_deg(90.0), 0.1), 0.0, 1e-12);
    EXPECT_NEAR(turn_run_mm(80.0, rad_from_deg(45.0), 0.25), 320.0 * (std::sqrt(2.0) - 1.0), 1e-9);
}

// Without friction the run is infinite, and is told so instead of printed.
TEST(WhyNoTurn, SaysWhatATurnTakes) {
    const Rim rim = slanted_rim();
    const RimCrossing c = crossing(0, 20, 1);
    const std::string far = why_no_turn("the rim", rim, c, {0.1, 50.0, 6.0});
    const double needed_mm = turn_run_mm(rim.radius_mm, c.angle_rad, 0.98 * 0.1) + 3.0;
    EXPECT_TRUE(test::tells(far, fixed(needed_mm, 1) + " mm")) << far;
    for (const double friction : {0.0, 1e-300, 1e-9}) {
        const std::string never = why_no_turn("the rim", rim, c, {friction, 50.0, 6.0});
        EXPECT_NE(never, "");
        for (const char* infinite : {"inf", "nan", "e+", "0000000"}) {
            EXPECT_EQ(never.find(infinite), std::string::npos) << never;
        }
    }
}

TEST(CanTurn, KeepsTheBandOnTheExtension) {
    const Rim rim = slanted_rim();
    // At 45 degrees the run is (R / slip)(sqrt 2 - 1); the band takes another half of its width.
    const double run = 40.0 / 0.25 * (std::sqrt(2.0) - 1.0);
    const RimCrossing c = crossing(0, 45, 1);
    EXPECT_TRUE(can_turn(rim, c, {0.25, run * 1.05 + 4.0, 8.0}));
    EXPECT_FALSE(can_turn(rim, c, {0.25, run * 0.999 + 4.0, 8.0}));
    EXPECT_FALSE(can_turn(rim, c, {0.0, 1000.0, 8.0}));
    EXPECT_FALSE(can_turn(rim, crossing(0, 0, 1), kRule));
    EXPECT_FALSE(can_turn(rim, crossing(0, 120, 1), kRule)) << "a fibre that comes in";
}

TEST(MakeTurn, StartsAndEndsAlongTheCourses) {
    const Rim rim = slanted_rim();
    for (const Case& c : cases()) {
        ASSERT_TRUE(can_turn(rim, c.from, kRule) && can_turn(rim, c.to, kRule));
        const SurfacePath path = make_turn(rim, c.from, c.to, kRule, kStep_mm).path;
        const Vector3d from = rim.centre_mm + rim.radius_mm * radial_at(rim, c.from.azimuth_rad);
        const Vector3d to = rim.centre_mm + rim.radius_mm * radial_at(rim, c.to.azimuth_rad);
        EXPECT_LT((path.front().position_mm - from).norm(), 1e-9);
        EXPECT_LT((path.front().tangent - outward_at(rim, c.from)).norm(), 1e-9);
        EXPECT_LT((path.back().position_mm - to).norm(), 1e-9);
        EXPECT_LT((path.back().tangent + outward_at(rim, c.to)).norm(), 1e-9);
    }
}

TEST(MakeTurn, IsContinuousOnTheExtension) {
    const Rim rim = slanted_rim();
    for (const Case& c : cases()) {
        const Turn turn = make_turn(rim, c.from, c.to, kRule, kStep_mm);
        double highest = 0.0;
        for (std::size_t i = 0; i < turn.path.size(); ++i) {
            const PathPoint& p = turn.path[i];
            const Vector3d d = p.position_mm - rim.centre_mm;
            const double height = d.dot(rim.axis);
            highest = std::max(highest, height);
            ASSERT_NEAR((d - height * rim.axis).norm(), rim.radius_mm, 1e-9);
            ASSERT_NEAR(p.tangent.dot(p.normal), 0.0, 1e-12);
            ASSERT_EQ(p.at.face, kNoFace);
            if (i == 0) {
                continue;
            }
            const PathPoint& q = turn.path[i - 1];
            const double ds = p.s_mm - q.s_mm;
            const double chord = (p.position_mm - q.position_mm).norm();
            ASSERT_GT(ds, 0.0);
            ASSERT_LE(ds, kStep_mm + 1e-9);
            // The curvature is at most sqrt(1 + friction^2) / R: arc - chord <= ds^3 k^2 / 24.
            ASSERT_NEAR(chord, ds, 1.1 * ds * ds * ds / (24.0 * 40.0 * 40.0) + 1e-9);
            ASSERT_GT(p.tangent.dot(q.tangent), std::cos(1.1 * kStep_mm / 40.0));
        }
        EXPECT_NEAR(highest, turn.run_mm, 1e-9);
        EXPECT_LE(turn.run_mm, kRule.extension_mm - 0.5 * kRule.band_mm + 1e-9);
    }
}

// Measured from the positions alone: the circle through three stations is off by (h / scale)^2.
TEST(MakeTurn, SlipMeasuredFromThePositionsIsTheSlipStated) {
    const Rim rim = slanted_rim();
    for (const Case& c : cases()) {
        const Turn turn = make_turn(rim, c.from, c.to, kRule, kStep_mm);
        double worst = 0.0;
        for (std::size_t i = 1; i + 1 < turn.path.size(); ++i) {
            const double stated = turn.path[i].kg_per_mm;
            const double kn =
                std::pow(turn.path[i].tangent.dot(rim.axis.cross(turn.path[i].normal)), 2) /
                rim.radius_mm;
            ASSERT_NEAR(turn.path[i].kn_per_mm, kn, 1e-12);
            worst = std::max(worst, std::abs(stated) / kn);
            // Where steering begins or ends the three stations lie on two laws.
            const double before = turn.path[i - 1].kg_per_mm / turn.path[i - 1].kn_per_mm;
            const double after = turn.path[i + 1].kg_per_mm / turn.path[i + 1].kn_per_mm;
            if (std::abs(before - stated / kn) < 1e-9 && std::abs(after - stated / kn) < 1e-9) {
                ASSERT_NEAR(measured_kg(rim, turn.path, i), stated,
                            kRule.friction.share(1e-3) * kn);
            }
        }
        EXPECT_NEAR(worst, turn.slip, 1e-9);
        EXPECT_LE(turn.slip, kRule.friction.holds());
    }
}

// phi = (1 / slip) ln cot(beta / 2) at either end, with the slip that the run gives.
TEST(MakeTurn, TurnsByTheClosedForm) {
    const Rim rim = slanted_rim();
    for (const Case& c : cases()) {
        const Turn turn = make_turn(rim, c.from, c.to, kRule, kStep_mm);
        double angle = turn.dwell_rad;
        for (const RimCrossing& end : {c.from, c.to}) {
            const double slip = turn_run_mm(rim.radius_mm, end.angle_rad, 1.0) / turn.run_mm;
            angle += std::log(1.0 / std::tan(0.5 * end.angle_rad)) / slip;
        }
        double walked = 0.0;
        for (std::size_t i = 1; i < turn.path.size(); ++i) {
            walked += difference(unrolled(rim, turn.path[i].position_mm).azimuth,
                                 unrolled(rim, turn.path[i - 1].position_mm).azimuth);
        }
        EXPECT_NEAR(walked, c.from.sense * angle, 1e-8);
    }
}

// A turn between two ends alike, without a dwell, is the half turn there and back.
TEST(HalfTurn, IsTheFirstHalfOfATurn) {
    const Rim rim = slanted_rim();
    const RimCrossing from = crossing(40.0, 55.0, 1);
    const Turn half = half_turn(rim, from, kRule, kStep_mm);
    EXPECT_NEAR(half.path.back().tangent.dot(rim.axis), 0.0, 1e-12);
    EXPECT_EQ(half.dwell_rad, 0.0);
    RimCrossing to = from;
    to.sense = -1;
    const Unrolled hoop = unrolled(rim, half.path.back().position_mm);
    to.azimuth_rad = hoop.azimuth + difference(hoop.azimuth, from.azimuth_rad) + 1e-9;
    const Turn whole = make_turn(rim, from, to, kRule, kStep_mm);
    EXPECT_NEAR(whole.dwell_rad, 0.0, 1e-8);
    EXPECT_EQ(whole.slip, half.slip);
    EXPECT_EQ(whole.run_mm, half.run_mm);
    for (std::size_t i = 0; i < half.path.size(); ++i) {
        EXPECT_EQ(whole.path[i].position_mm, half.path[i].position_mm);
    }
}

TEST(TurnFibre, IsTheLengthOfTheTurnThatIsMade) {
    const Rim rim = slanted_rim();
    for (const Case& c : cases()) {
        const Turn turn = make_turn(rim, c.from, c.to, kRule, kStep_mm);
        EXPECT_NEAR(turn_mm(rim, c.from, c.to, kRule), turn.path.back().s_mm, 1e-9);
        const Turn half = half_turn(rim, c.from, kRule, kStep_mm);
        EXPECT_NEAR(half_turn_mm(rim, c.from, kRule), half.path.back().s_mm, 1e-9);
    }
}

TEST(DwellAngle, IsTheSameBothWaysAndWithinOneTurn) {
    const Rim rim = slanted_rim();
    for (const Case& c : cases()) {
        const double there = dwell_rad(rim, c.from, c.to, kRule);
        const double back = dwell_rad(rim, c.to, c.from, kRule);
        EXPECT_GE(there, 0.0);
        EXPECT_LT(there, 2.0 * kPi);
        EXPECT_NEAR(difference(there, back), 0.0, 1e-12);
    }
}

// A turn without dwell: rounding must give almost nothing or almost a whole turn, never a whole
// one.
TEST(DwellAngle, StaysBelowAWholeTurnWhereRoundingIsAllThereIs) {
    const Rim rim = slanted_rim();
    for (Case c : cases()) {
        c.to.azimuth_rad = c.from.azimuth_rad;
        const double all = 2.0 * kPi - dwell_rad(rim, c.from, c.to, kRule);
        double azimuth = c.from.azimuth_rad + c.from.sense * all;
        for (int i = 0; i < 8; ++i) {
            azimuth = std::nextafter(azimuth, -100.0);
        }
        for (int i = 0; i < 16; ++i) {
            c.to.azimuth_rad = azimuth = std::nextafter(azimuth, 100.0);
            const double dwell = dwell_rad(rim, c.from, c.to, kRule);
            ASSERT_GE(dwell, 0.0);
            ASSERT_LT(dwell, 2.0 * kPi);
        }
    }
}

}  // namespace
}  // namespace meshwind
