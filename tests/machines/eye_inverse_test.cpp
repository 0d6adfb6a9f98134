#include "machines/eye_inverse.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/support/machine_draws.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

using test::Draw;
using test::machine_file;

// A target that the joints meet: the roller along the binormal, the fibre across it.
EyeTarget target_at(const Machine& machine, const std::vector<double>& joints, Draw& draw) {
    const Isometry3d eye = mandrel_from_eye(machine, joints);
    EyeTarget target;
    target.eye_mm = eye.translation();
    target.binormal = eye.linear() * machine.eye.roller;
    target.tangent = target.binormal.cross(draw.direction()).normalized();
    return target;
}

double miss_mm(const Machine& machine, const std::vector<double>& joints, const EyeTarget& target) {
    return (mandrel_from_eye(machine, joints).translation() - target.eye_mm).norm();
}

double twist_rad(const Machine& machine, const std::vector<double>& joints,
                 const EyeTarget& target) {
    const Vector3d roller = mandrel_from_eye(machine, joints).linear() * machine.eye.roller;
    return std::asin(std::min(roller.cross(target.binormal).norm(), 1.0));
}

// With the turn that the place forces the closed form comes back to the pose.
TEST(SpindleWristInverse, RoundTripWithFewerAxes) {
    for (const char* name : {"two_axis", "four_axis", "hobby_grbl"}) {
        SCOPED_TRACE(name);
        const Machine machine = machine_file(name);
        const SpindleWristInverse inverse(machine);
        Draw draw(1);
        for (int i = 0; i < 5000; ++i) {
            std::vector<double> wanted = draw.joints(machine);
            const EyeTarget target = target_at(machine, wanted, draw);
            std::vector<double> q(machine.axis_count(), 0.0);
            const auto turn = inverse.forced_turn(target, wanted[0] + draw.between(-3.0, 3.0));
            ASSERT_TRUE(turn);
            EXPECT_NEAR(std::remainder(*turn - wanted[0], 2.0 * kPi), 0.0, 1e-9);
            const WristState state = inverse.solve(target, *turn, wanted, q);
            ASSERT_LT(state.residual_mm, 1e-9);
            ASSERT_LT(miss_mm(machine, q, target), 1e-9);
            // The roller may be turned over; it is across the fibre where the head can turn.
            ASSERT_NEAR(state.twist_rad, twist_rad(machine, q, target), 1e-9);
            if (inverse.has_roll()) {
                const Vector3d roller = mandrel_from_eye(machine, q).linear() * machine.eye.roller;
                ASSERT_LT(std::abs(roller.dot(target.tangent)), 1e-9);
            } else {
                ASSERT_LT(state.twist_rad, 1e-9);
            }
        }
    }
}

// Fibre along X cannot set the roll: it is kept, and the place is met all the same.
TEST(SpindleWristInverse, SingularHeadWithFewerAxesKeepsItsRoll) {
    for (const char* name : {"four_axis", "hobby_grbl"}) {
        const Machine machine = machine_file(name);
        const SpindleWristInverse inverse(machine);
        for (const double off : {0.0, 1e-12, 1e-8}) {
            std::vector<double> q(machine.axis_count(), 0.0);
            q.back() = 0.4;
            const double radius = machine.eye.position_mm.x() > 0.0 ? 60.0 : 200.0;
            const EyeTarget target{.eye_mm = {radius, 0.0, 10.0},
                                   .tangent = Vector3d(1.0, 0.0, off).normalized(),
                                   .binormal = Vector3d::UnitY()};
            const WristState state = inverse.solve(target, 0.0, q, q);
            EXPECT_EQ(state.held, off < kSingularSine);
            EXPECT_LT(state.residual_mm, 1e-12);
            EXPECT_NEAR(q.back(), state.held ? 0.4 : 0.5 * kPi, 1e-6);
        }
    }
}

TEST(SpindleWristInverse, TellsHowFarAPlaceIsOutOfReach) {
    // Without the axis along Y: at a turn that is off by d the eye misses by r sin d.
    const Machine four = machine_file("four_axis");
    const SpindleWristInverse of_four(four);
    Draw draw(2);
    for (int i = 0; i < 1000; ++i) {
        const double r = draw.between(50.0, 500.0);
        const double angle = draw.between(-3.0, 3.0);
        const double off = draw.between(-1.5, 1.5);
        const EyeTarget target{
            .eye_mm = {r * std::cos(angle), r * std::sin(angle), draw.between(-900.0, 900.0)}};
        std::vector<double> q(four.axis_count(), 0.0);
        EXPECT_NEAR(*of_four.forced_turn(target, 0.0), -angle, 1e-12);
        const WristState state = of_four.solve(target, off - angle, q, q);
        EXPECT_NEAR(state.residual_mm, r * std::abs(std::sin(off)), 1e-9);
        EXPECT_NEAR(state.residual_mm, miss_mm(four, q, target), 1e-9);
    }
    // With the carriage alone: by the difference of the distances from the spindle axis.
    const Machine two = machine_file("two_axis");
    const SpindleWristInverse of_two(two);
    for (const double radius : {40.0, 58.31, 70.5}) {
        const EyeTarget target{.eye_mm = {0.0, radius, 12.0}};
        std::vector<double> q(two.axis_count(), 0.0);
        const double turn = *of_two.forced_turn(target, 0.0);
        EXPECT_NEAR(turn, -0.5 * kPi, 1e-12);
        EXPECT_NEAR(of_two.solve(target, turn, q, q).residual_mm, std::abs(radius - 58.31), 1e-12);
    }
}

// The eye beside the plane through the axis: two turns bring it to the target, of which the slide's
// travel allows one.
TEST(SpindleWristInverse, ForcedTurnOfAnEyeBesideTheAxis) {
    Machine machine = machine_file("four_axis");
    machine.eye.position_mm = {0.0, 20.0, 0.0};
    machine.eye_chain[2].point_mm = {0.0, 20.0, 0.0};
    const SpindleWristInverse inverse(machine);
    Draw draw(3);
    for (int i = 0; i < 1000; ++i) {
        const EyeTarget target{.eye_mm = {draw.between(100.0, 300.0), draw.between(-200.0, 200.0),
                                          draw.between(-500.0, 500.0)},
                               .tangent = Vector3d::UnitY(),
                               .binormal = Vector3d::UnitZ()};
        std::vector<double> q(machine.axis_count(), 0.0);
        const double turn = *inverse.forced_turn(target, draw.between(-3.0, 3.0));
        EXPECT_LT(inverse.solve(target, turn, q, q).residual_mm, 1e-9);
        EXPECT_GT(q[*machine.joint_of('X')], 0.0);
    }
}

TEST(SpindleWristInverse, MandrelFurtherAlongTheSpindle) {
    Machine machine = machine_file("six_axis");
    machine.mount = MandrelMount{.origin_mm = {0.0, 0.0, 123.0}};
    const SpindleWristInverse inverse(machine);
    Draw draw(4);
    for (int i = 0; i < 1000; ++i) {
        const EyeTarget target = target_at(machine, draw.joints(machine), draw);
        std::vector<double> q(machine.axis_count(), 0.0);
        (void)inverse.solve(target, draw.between(-9.0, 9.0), q, q);
        ASSERT_LT(miss_mm(machine, q, target), 1e-9);
        ASSERT_LT(twist_rad(machine, q, target), 1e-9);
    }
}

// Random poses from joints near by and from far away. A far start may end beyond the travel or in
// another place of rest, but never says so wrongly.
void expect_numeric_round_trip(const Machine& machine, unsigned seed, int count, double found) {
    const NumericEyeInverse inverse(machine);
    Draw draw(seed);
    int far_reached = 0;
    for (int i = 0; i < count; ++i) {
        std::vector<double> wanted = draw.joints(machine);
        const EyeTarget target = target_at(machine, wanted, draw);
        std::vector<double> near = wanted;
        for (double& q : near) {
            q += draw.between(-0.05, 0.05);
        }
        std::vector<double> q(machine.axis_count());
        WristState state = inverse.solve(target, wanted[0], near, q);
        ASSERT_LT(state.residual_mm, 1e-9);
        ASSERT_LT(state.twist_rad, 1e-9);
        ASSERT_LT(miss_mm(machine, q, target), 1e-9);
        ASSERT_LT(twist_rad(machine, q, target), 1e-9);

        state = inverse.solve(target, wanted[0], std::vector<double>(q.size(), 0.0), q);
        EXPECT_NEAR(state.residual_mm, miss_mm(machine, q, target), 1e-9);
        EXPECT_NEAR(state.twist_rad, twist_rad(machine, q, target), 1e-8);
        far_reached += state.residual_mm < 1e-9 && state.twist_rad < 1e-9 ? 1 : 0;
    }
    EXPECT_GE(far_reached, found * count);
}

TEST(NumericEyeInverse, RoundTripOfSpindleMachines) {
    expect_numeric_round_trip(machine_file("six_axis"), 1, 1000, 1.0);
    // Head swing before head roll: no closed form here.
    Machine machine = machine_file("six_axis");
    std::swap(machine.eye_chain[3], machine.eye_chain[4]);
    EXPECT_FALSE(machine_class(machine).closed_form);
    expect_numeric_round_trip(machine, 2, 1000, 0.9);
    // A wrist that does not pass through the eye, and an inclined spindle.
    machine = machine_file("six_axis");
    machine.eye_chain[3].point_mm = {0.0, 15.0, 4.0};
    machine.eye_chain[4].point_mm = {40.0, 15.0, 30.0};
    expect_numeric_round_trip(machine, 3, 1000, 0.95);
    machine.mandrel_chain[0].direction = Vector3d(0.6, 0.0, 0.8);
    expect_numeric_round_trip(machine, 4, 500, 0.95);
}

TEST(NumericEyeInverse, RoundTripOfRobots) {
    expect_numeric_round_trip(
        read_machine(std::string(MESHWIND_SOURCE_DIR) +
                     "/data/conformance/machine/valid/six_revolute_robot.json"),
        5, 1000, 0.8);
    expect_numeric_round_trip(machine_file("robot_kr16"), 6, 1000, 0.8);
}

TEST(NumericEyeInverse, NearSingularPosesAreReached) {
    Machine machine = machine_file("six_axis");
    std::swap(machine.eye_chain[3], machine.eye_chain[4]);
    const NumericEyeInverse inverse(machine);
    Draw draw(7);
    // Swing, then roll about X: the roller cannot leave the plane it is in when it lies along Y.
    const std::size_t roll = *machine.joint_of('A');
    for (const double off : {0.0, 1e-10, 1e-6, 1e-3}) {
        for (int i = 0; i < 200; ++i) {
            std::vector<double> wanted = draw.joints(machine);
            wanted[roll] = 0.5 * kPi + off;
            const EyeTarget target = target_at(machine, wanted, draw);
            std::vector<double> near = wanted;
            near[roll] += draw.between(-0.01, 0.01);
            std::vector<double> q(machine.axis_count());
            const WristState state = inverse.solve(target, wanted[0], near, q);
            ASSERT_LT(state.residual_mm, 1e-9);
            ASSERT_LT(state.twist_rad, 1e-9) << off;
            EXPECT_LE(state.singular_sine, 2.0 * off + 1e-4);
        }
    }
}

TEST(NumericEyeInverse, TellsWhatIsOutOfReach) {
    const Machine machine = read_machine(std::string(MESHWIND_SOURCE_DIR) +
                                         "/data/conformance/machine/valid/six_revolute_robot.json");
    const NumericEyeInverse inverse(machine);
    const EyeTarget target{.eye_mm = {0.0, 0.0, 20000.0}};
    std::vector<double> q(machine.axis_count(), 0.0);
    const WristState state = inverse.solve(target, 0.0, q, q);
    EXPECT_GT(state.residual_mm, 15000.0);
    EXPECT_NEAR(state.residual_mm, miss_mm(machine, q, target), 1e-6);
    // Too few axes for a roller: the place is met, the twist is told.
    Machine few = machine_file("four_axis");
    few.mandrel_chain[0].direction = Vector3d(0.6, 0.0, 0.8);
    Draw draw(8);
    for (int i = 0; i < 200; ++i) {
        const std::vector<double> wanted = draw.joints(few);
        EyeTarget aim = target_at(few, wanted, draw);
        aim.binormal = aim.tangent.cross(draw.direction()).normalized();
        std::vector<double> near(wanted);
        const WristState found = NumericEyeInverse(few).solve(aim, 0.0, near, near);
        EXPECT_LT(miss_mm(few, near, aim), 1e-9);
        EXPECT_NEAR(found.twist_rad, twist_rad(few, near, aim), 1e-8);
    }
}

TEST(MachineClass, NamesTheShippedMachines) {
    const auto words = [](const char* name) { return machine_class(machine_file(name)).words; };
    EXPECT_EQ(words("six_axis"), "spindle, 3 linear axes, head roll and swing: closed form");
    EXPECT_EQ(words("five_axis"), "spindle, 3 linear axes, head roll: closed form");
    EXPECT_EQ(words("four_axis"), "spindle, 2 linear axes, head roll: closed form");
    EXPECT_EQ(words("hobby_grbl"), "spindle, 1 linear axis, head roll: closed form");
    EXPECT_EQ(words("two_axis"), "spindle, 1 linear axis, head that does not turn: closed form");
    EXPECT_EQ(words("robot_winder"), "spindle, arm that holds the eye: closed form");
    EXPECT_EQ(words("robot_track"), "spindle, arm that holds the eye, on a track: closed form");
    EXPECT_EQ(words("robot_kr16"),
              "arm: 6 axes move the mandrel, the eye stands still: closed form for poses of the "
              "mandrel");
    for (const char* name : {"six_axis", "five_axis", "four_axis", "robot_winder", "robot_track"}) {
        EXPECT_EQ(machine_class(machine_file(name)).refusal, "");
        EXPECT_NO_THROW(require_main_job(machine_file(name)));
    }
    Machine sideways = machine_file("four_axis");  // carriage and height, no cross feed
    sideways.eye_chain[1].direction = Vector3d::UnitY();
    EXPECT_TRUE(machine_class(sideways).closed_form);
    EXPECT_THROW(require_main_job(sideways), InputError);
    EXPECT_NE(machine_class(machine_file("robot_kr16")).refusal, "");
    EXPECT_THROW(require_main_job(machine_file("robot_kr16")), InputError);
}

TEST(MachineClass, KnowsTheDistanceThatACarriageAloneKeeps) {
    for (const auto& [name, distance_mm] : {std::pair("two_axis", 58.31), {"hobby_grbl", 60.0}}) {
        EXPECT_DOUBLE_EQ(machine_class(machine_file(name)).eye_distance_mm, distance_mm);
        EXPECT_EQ(machine_class(machine_file(name)).refusal, "");
        EXPECT_NO_THROW(require_main_job(machine_file(name), distance_mm));
        EXPECT_THROW(require_main_job(machine_file(name), distance_mm + 1.0), InputError);
        EXPECT_THROW(require_main_job(machine_file(name)), InputError);
    }
    Machine without_cross_feed = machine_file("four_axis");  // its eye is on the spindle axis
    without_cross_feed.eye_chain.erase(without_cross_feed.eye_chain.begin() + 1);
    EXPECT_EQ(machine_class(without_cross_feed).eye_distance_mm, 0.0);
    EXPECT_NE(machine_class(without_cross_feed).refusal, "");
    EXPECT_THROW(require_main_job(without_cross_feed), InputError);
    Machine without_carriage = machine_file("four_axis");
    without_carriage.eye_chain.erase(without_carriage.eye_chain.begin());
    EXPECT_EQ(machine_class(without_carriage).eye_distance_mm, 0.0);
    EXPECT_THROW(require_main_job(without_carriage), InputError);
}

TEST(MakeEyeInverse, TakesTheClosedFormWhereItHolds) {
    EXPECT_NE(dynamic_cast<SpindleWristInverse*>(make_eye_inverse(machine_file("two_axis")).get()),
              nullptr);
    EXPECT_NE(dynamic_cast<NumericEyeInverse*>(make_eye_inverse(machine_file("robot_kr16")).get()),
              nullptr);
}

}  // namespace
}  // namespace meshwind
