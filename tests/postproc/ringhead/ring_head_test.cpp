#include "postproc/ringhead/ring_head.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/l_frame.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Json = nlohmann::json;

TEST(CarriedPose, BringsPointTangentAndReferenceToTheHead) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    const auto vector = [&] { return Vector3d(part(random), part(random), part(random)); };
    for (int i = 0; i < 1000; ++i) {
        RingHead head;
        head.centre_mm = 2000.0 * vector();
        head.direction = vector().normalized();
        head.reference = head.direction.cross(vector()).normalized();
        AxisFrame axis;
        axis.point_mm = 1000.0 * vector();
        axis.tangent = vector().normalized();
        axis.reference = axis.tangent.cross(vector()).normalized();
        const Isometry3d pose = carried_pose(head, axis);
        ASSERT_LT((pose * axis.point_mm - head.centre_mm).norm(), 1e-9);
        ASSERT_LT((pose.linear() * axis.tangent - head.direction).norm(), 1e-9);
        ASSERT_LT((pose.linear() * axis.reference - head.reference).norm(), 1e-9);
        ASSERT_NEAR(pose.linear().determinant(), 1.0, 1e-12);
        const CarryError error = carry_error(head, pose, axis);
        ASSERT_LT(error.distance_mm, 1e-9);
        ASSERT_LT(error.turn_rad, 1e-7);  // of quaternions
    }
}

TEST(CarriedPose, GivesThePosesOfTheLFrame) {
    const Json reference = test::l_frame_reference();
    const RingHead head = test::l_frame_head();
    ASSERT_EQ(reference["poses"].size(), 16u);
    double largest_b_deg = 0.0;
    for (const Json& row : reference["poses"]) {
        const Isometry3d pose = carried_pose(head, test::l_frame_at(row["s_mm"].get<double>()));
        const EulerZyx angles = euler_zyx(pose.linear());
        EXPECT_LT((pose.translation() - test::vector_of(row["xyz"])).norm(), 2e-9) << row;
        Matrix3d printed;
        for (int i = 0; i < 3; ++i) {
            printed.row(i) = test::vector_of(row["R"][static_cast<std::size_t>(i)]).transpose();
        }
        EXPECT_LT((pose.linear() - printed).norm(), 3e-12) << row;
        // a = +-180 is one angle
        const Vector3d abc = test::vector_of(row["abc_deg"]);
        EXPECT_LT(std::abs(std::remainder(deg_from_rad(angles.a_rad) - abc.x(), 360.0)), 2e-9);
        EXPECT_NEAR(deg_from_rad(angles.b_rad), abc.y(), 2e-9);
        EXPECT_LT(std::abs(std::remainder(deg_from_rad(angles.c_rad) - abc.z(), 360.0)), 2e-9);
    }
    for (double s = 0.0; s <= test::kFrame_mm; s += 0.5) {
        const EulerZyx angles = euler_zyx(carried_pose(head, test::l_frame_at(s)).linear());
        largest_b_deg = std::max(largest_b_deg, std::abs(deg_from_rad(angles.b_rad)));
    }
    EXPECT_NEAR(largest_b_deg, reference["largest_b_deg"].get<double>(), 1e-9);
}

TEST(EulerZyx, GivesTheRotationBackEvenWhereItIsSingular) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> angle(-kPi, kPi);
    for (int i = 0; i < 1000; ++i) {
        // every third one exactly at, every third one next to the singular angle
        const double b = i % 3 == 0 ? 0.5 * kPi : i % 3 == 1 ? -0.5 * kPi + 1e-9 : angle(random);
        const Matrix3d rotation = EulerZyx{angle(random), b, angle(random)}.matrix();
        const EulerZyx found = euler_zyx(rotation);
        ASSERT_LT((found.matrix() - rotation).norm(), 1e-9);
        ASSERT_LE(std::abs(found.b_rad), 0.5 * kPi + 1e-12);
        const EulerZyx before{angle(random), angle(random), angle(random)};
        ASSERT_LT((euler_zyx(rotation, before).matrix() - rotation).norm(), 1e-9);
    }
}

TEST(EulerZyx, KeepsAWhereOnlyADifferenceIsDefined) {
    const Matrix3d rotation = EulerZyx{0.7, 0.5 * kPi, 0.3}.matrix();
    EXPECT_EQ(euler_zyx(rotation).a_rad, 0.0);
    const EulerZyx found = euler_zyx(rotation, EulerZyx{0.7, 1.5, 0.3});
    EXPECT_EQ(found.a_rad, 0.7);
    EXPECT_NEAR(found.c_rad, 0.3, 1e-9);
}

TEST(EulerZyx, ContinuesOverWholeTurnsAndThroughTheSingularAngle) {
    EulerZyx before{3.0, 0.2, -3.0};
    for (int i = 1; i <= 2000; ++i) {
        // a and c run over several turns, b from 0.2 over pi/2 to 2.2
        const EulerZyx exact{3.0 + 0.01 * i, 0.2 + 0.001 * i, -3.0 - 0.008 * i};
        before = euler_zyx(exact.matrix(), before);
        ASSERT_NEAR(before.a_rad, exact.a_rad, 1e-9) << i;
        ASSERT_NEAR(before.b_rad, exact.b_rad, 1e-9) << i;
        ASSERT_NEAR(before.c_rad, exact.c_rad, 1e-9) << i;
    }
}

// Half way on the move from one station to the next, the worst of all of them.
CarryError worst_half_way(double h, TurnLaw law = TurnLaw::OneAxis) {
    const RingHead head = test::l_frame_head();
    CarryError worst;
    for (double s = 0.0; s < test::kFrame_mm - 0.5 * h; s += h) {
        const CarryError error =
            carry_error(head,
                        lin_between(carried_pose(head, test::l_frame_at(s)),
                                    carried_pose(head, test::l_frame_at(s + h)), 0.5, law),
                        test::l_frame_at(s + 0.5 * h));
        worst.distance_mm = std::max(worst.distance_mm, error.distance_mm);
        worst.tilt_rad = std::max(worst.tilt_rad, error.tilt_rad);
    }
    return worst;
}

TEST(LinBetween, LeavesTheHeadByThePublishedExamplesNumbers) {
    const Json reference = test::l_frame_reference();
    for (const Json& row : reference["interpolation"]) {
        const CarryError error = worst_half_way(row["h_mm"].get<double>());
        EXPECT_NEAR(error.distance_mm, row["distance_mm"].get<double>(), 1e-6);
        EXPECT_NEAR(deg_from_rad(error.tilt_rad), row["tilt_deg"].get<double>(), 1e-6);
    }
}

TEST(LinBetween, TheTwoLawsOfTurningMeetAtTheEndsAndDifferByAnEighthOfTheirProduct) {
    const Isometry3d from = carried_pose(test::l_frame_head(), test::l_frame_at(600.0));
    Isometry3d to = from;
    const double swivel = 0.04;
    const double spin = 0.07;
    to.linear() = from.linear() * Eigen::AngleAxisd(swivel, Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(spin, Vector3d::UnitX());
    const SwivelSpin angles = swivel_and_spin(from, to);
    EXPECT_NEAR(angles.swivel_rad, swivel, 1e-12);
    EXPECT_NEAR(angles.spin_rad, spin, 1e-12);
    const auto gap = [&](double share) {
        const Eigen::AngleAxisd turn(
            Matrix3d(lin_between(from, to, share).linear().transpose() *
                     lin_between(from, to, share, TurnLaw::SwivelAndSpin).linear()));
        return turn.angle();
    };
    EXPECT_LT(gap(0.0), 1e-9);
    EXPECT_LT(gap(1.0), 1e-9);
    EXPECT_NEAR(gap(0.5), swivel * spin / 8.0, 0.02 * swivel * spin / 8.0);
    // By the second law X stays on the great circle.
    const Vector3d across = from.linear().col(0).cross(to.linear().col(0));
    for (const double share : {0.2, 0.5, 0.9}) {
        const Vector3d x = lin_between(from, to, share, TurnLaw::SwivelAndSpin).linear().col(0);
        EXPECT_LT(std::abs(x.dot(across)), 1e-12);
        EXPECT_NEAR(std::acos(x.dot(from.linear().col(0))), share * swivel, 1e-9);
    }
}

TEST(LinError, MeasuresTheSameBetweenTheStationsOfATable) {
    const RingHead head = test::l_frame_head();
    const FrameAxis axis = test::l_frame(10.0);
    const Json reference = test::l_frame_reference();
    for (const Json& row : reference["interpolation"]) {
        const double h = row["h_mm"].get<double>();
        CarryError worst;
        for (double s = 0.0; s < test::kFrame_mm - 0.5 * h; s += h) {
            const double end = std::min(s + h, axis.length_mm());
            const CarryError error = lin_error(head, axis, s, end, carried_pose(head, axis.at(s)),
                                               carried_pose(head, axis.at(end)));
            worst.distance_mm = std::max(worst.distance_mm, error.distance_mm);
            worst.tilt_rad = std::max(worst.tilt_rad, error.tilt_rad);
        }
        // Along the axis the fit is off by 5e-4 mm, on a lever of 640 mm turned 1.3 deg/mm. The
        // largest error need not be half way, and it may be that of the other law.
        const double expected = std::max(row["distance_mm"].get<double>(),
                                         worst_half_way(h, TurnLaw::SwivelAndSpin).distance_mm);
        EXPECT_NEAR(worst.distance_mm, expected, 0.02 + 0.005 * expected) << h;
        EXPECT_GE(deg_from_rad(worst.tilt_rad), 0.99 * row["tilt_deg"].get<double>());
    }
}

TEST(ChooseCarryPoints, KeepsTheToleranceEverywhereOnTheExactFrame) {
    const RingHead head = test::l_frame_head();
    const FrameAxis axis = test::l_frame(10.0);
    for (const CarryTolerance& tolerance :
         {CarryTolerance{}, CarryTolerance{1.0, rad_from_deg(0.2)},
          CarryTolerance{0.02, rad_from_deg(0.02)}, CarryTolerance{5.0, rad_from_deg(0.05)}}) {
        const CarryPoints points = choose_carry_points(head, axis, tolerance);
        ASSERT_TRUE(points.ok);
        EXPECT_EQ(points.s_mm.front(), 0.0);
        EXPECT_EQ(points.s_mm.back(), axis.length_mm());
        double distance = 0.0;
        double turn = 0.0;
        for (std::size_t i = 1; i < points.s_mm.size(); ++i) {
            const double from = points.s_mm[i - 1];
            const double to = points.s_mm[i];
            for (int k = 0; k <= 37; ++k) {  // between the samples of the measurement
                const double s = from + (to - from) * k / 37.0;
                for (const TurnLaw law : {TurnLaw::OneAxis, TurnLaw::SwivelAndSpin}) {
                    const CarryError error =
                        carry_error(head,
                                    lin_between(carried_pose(head, axis.at(from)),
                                                carried_pose(head, axis.at(to)), k / 37.0, law),
                                    test::l_frame_at(s));
                    distance = std::max(distance, error.distance_mm);
                    turn = std::max(turn, error.turn_rad);
                    ASSERT_LE(error.tilt_rad, error.turn_rad + 1e-9);
                }
            }
        }
        EXPECT_LE(distance, tolerance.distance_mm);
        EXPECT_LE(turn, tolerance.angle_rad);
        EXPECT_NEAR(distance, points.worst.distance_mm, 0.01 * distance + 1e-3);
        // Neither arm needs points: on both the error is nothing.
        EXPECT_LT(points.s_mm.size(), 450u);
        EXPECT_GT(distance / tolerance.distance_mm + turn / tolerance.angle_rad, 0.25);
    }
}

TEST(ChooseCarryPoints, SaysWhereATurnInOnePlaceCannotBeCarried) {
    // Half a turn over 0.2 mm: no move is short enough.
    std::vector<AxisStation> stations = {
        {Vector3d(0, 0, 0), Vector3d::UnitZ(), Vector3d::UnitY(), 0.0},
        {Vector3d(0, 0, 50), Vector3d::UnitZ(), Vector3d::UnitY(), 0.0},
        {Vector3d(0, 0, 50.2), Vector3d::UnitZ(), Vector3d::UnitY(), kPi},
        {Vector3d(0, 0, 90), Vector3d::UnitZ(), Vector3d::UnitY(), kPi}};
    stations[2].point_mm.x() = 0.1;  // and to the side
    const FrameAxis axis(stations);
    const CarryPoints points = choose_carry_points(test::l_frame_head(), axis, {1e-4, 1e-6});
    EXPECT_FALSE(points.ok);
    EXPECT_NEAR(points.worst_s_mm, 50.0, 0.3);
}

TEST(RingFit, OfTheBendInTheTwoRings) {
    const Json fit = test::l_frame_reference()["ring_fit"];
    const double tube = test::l_frame_reference()["tube_radius_mm"].get<double>();
    const RingFit found = worst_ring_fit(test::l_frame_head(), test::l_frame(10.0), tube);
    EXPECT_TRUE(found.through);
    EXPECT_NEAR(found.reach_mm, fit["reach_mm"].get<double>(), 1e-4);
    EXPECT_NEAR(found.offset_mm, fit["offset_mm"].get<double>(), 1e-4);
    EXPECT_NEAR(deg_from_rad(found.tilt_rad), fit["tilt_deg"].get<double>(), 1e-4);
    EXPECT_GT(found.s_mm, 580.0);
    EXPECT_LT(found.s_mm, 660.0);
}

TEST(RingFit, SaysThatABendIsTooTightForTheHead) {
    RingHead head = test::l_frame_head();
    head.ring_distance_mm = 2.5 * test::kBendRadius_mm;  // the axis turns back before
    std::vector<AxisStation> stations;
    for (int i = 0; i <= 18; ++i) {
        const double angle = kPi * i / 18.0;
        stations.push_back({50.0 * Vector3d(1.0 - std::cos(angle), 0.0, std::sin(angle)),
                            Vector3d(std::sin(angle), 0.0, std::cos(angle)), Vector3d::UnitY(),
                            0.0});
    }
    EXPECT_FALSE(worst_ring_fit(head, FrameAxis(stations), 20.0).through);
}

TEST(RingWinding, LaysTheWantedAngle) {
    const Json reference = test::l_frame_reference();
    const double angle = rad_from_deg(45.0);
    const double turns_per_mm = ring_turns_per_mm(angle, 20.0);
    EXPECT_NEAR(1.0 / turns_per_mm, reference["mm_per_turn_at_45_deg"].get<double>(), 1e-9);
    const double v = 30.0;
    const double ring = 2.0 * kPi * turns_per_mm * v;
    EXPECT_NEAR(laid_angle_rad(20.0, ring, 0.0, v), angle, 1e-12);
    EXPECT_NEAR(laid_angle_rad(20.0, -ring, 0.0, v), -angle, 1e-12);
    // The frame turns by half a turn over 140 mm: what lies along the axis leans.
    const double frame = kPi / 140.0 * v;
    EXPECT_NEAR(deg_from_rad(laid_angle_rad(20.0, 0.0, frame, v)),
                -reference["fibre_tilt_deg"].get<double>(), 1e-9);
    EXPECT_NEAR(std::tan(laid_angle_rad(20.0, ring, frame, v)), 1.0 - 0.448799, 1e-6);
    EXPECT_NEAR(laid_angle_rad(20.0, ring + frame, frame, v), angle, 1e-12);
    // Twelve tows of 7.4 mm at 45 deg: 12 * 7.4 * sqrt(2) = 125.58 of 125.66 mm.
    EXPECT_NEAR(ring_coverage(12, 7.4, angle, 20.0), 125.58 / 125.664, 1e-4);
}

TEST(FrameTurn, IsThatOfTheReference) {
    const RingHead head = test::l_frame_head();
    double turn = 0.0;
    for (double s = 0.0; s < test::kFrame_mm; s += 1.0) {
        turn += frame_turn_rad(head, carried_pose(head, test::l_frame_at(s)),
                               carried_pose(head, test::l_frame_at(s + 1.0)));
    }
    // The bend's own turn is about an axis across, which turns with the frame: second order.
    EXPECT_NEAR(turn, kPi, 1e-3);
}

}  // namespace
}  // namespace meshwind
