#include "machines/arm_eye_inverse.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "machines/eye_inverse.h"
#include "tests/support/machine_draws.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

using test::Draw;
using test::machine_file;

// An eye beside a mandrel of some 100 mm; at a turn of zero the robot's side is +X.
EyeTarget drawn_target(Draw& draw) {
    EyeTarget target;
    target.eye_mm = {draw.between(60.0, 350.0), draw.between(-150.0, 150.0),
                     draw.between(-300.0, 300.0)};
    target.tangent = draw.direction();
    target.binormal = target.tangent.cross(draw.direction()).normalized();
    return target;
}

bool within_limits(const Machine& machine, const std::vector<double>& joints) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
        if (joints[j] < machine.axis(j).min || joints[j] > machine.axis(j).max) {
            return false;
        }
    }
    return true;
}

// Place, roller and exit as the joints bring them, against what is asked.
void expect_held(const Machine& machine, const std::vector<double>& joints,
                 const EyeTarget& target) {
    const Isometry3d eye = mandrel_from_eye(machine, joints);
    ASSERT_LT((eye.translation() - target.eye_mm).norm(), 1e-9);
    ASSERT_LT(std::abs(target.tangent.dot(eye.linear() * machine.eye.roller)), 1e-9);
    const Isometry3d base = base_from_eye(machine, joints);
    ASSERT_LT((base.linear() * machine.eye.exit + Vector3d::UnitX()).norm(), 1e-9);
}

// The robot is that of robot_kr16.json, whose lengths are held against a table of joints in
// pose_inverse_test.cpp: turned to look along -X with Y up, and a tube of 200 mm at its flange.
TEST(ArmEyeInverse, TheRobotIsTheOneThatCarriesFrames) {
    const Machine machine = machine_file("robot_winder");
    const Machine robot = machine_file("robot_kr16");
    Isometry3d here = Isometry3d::Identity();
    here.linear() << -Vector3d::UnitX(), Vector3d::UnitZ(), Vector3d::UnitY();
    here.translation() = Vector3d(1600.0, -400.0, 0.0);
    Draw draw(3);
    for (int i = 0; i < 100; ++i) {
        std::vector<double> joints{0.0};
        for (const Axis& axis : robot.mandrel_chain) {
            joints.push_back(draw.between(axis.min, axis.max));
        }
        const Isometry3d flange = base_from_mandrel(robot, std::span(joints).subspan(1));
        const Vector3d tip = here * (flange * Vector3d(0.0, 0.0, 200.0));
        ASSERT_LT((base_from_eye(machine, joints).translation() - tip).norm(), 1e-9);
    }
}

TEST(ArmEyeInverse, BringsTheEyeThereAndHoldsTheHead) {
    for (const char* name : {"robot_winder", "robot_track"}) {
        SCOPED_TRACE(name);
        const Machine machine = machine_file(name);
        const auto inverse = ArmEyeInverse::recognise(machine);
        ASSERT_TRUE(inverse);
        Draw draw(1);
        int reached = 0;
        for (int i = 0; i < 10000; ++i) {
            EyeTarget target = drawn_target(draw);
            const double turn = draw.between(-40.0, 40.0);
            const Eigen::AngleAxisd back(-turn, Vector3d::UnitZ());
            for (Vector3d* v : {&target.eye_mm, &target.tangent, &target.binormal}) {
                *v = back * *v;
            }
            const auto ways = inverse->starts(target, turn);
            for (const std::vector<double>& way : ways) {
                ASSERT_TRUE(within_limits(machine, way));
                expect_held(machine, way, target);
                std::vector<double> again(way.size());
                const WristState state = inverse->solve(target, turn, way, again);
                ASSERT_FALSE(state.flip);
                ASSERT_LT(state.residual_mm, 1e-9);
                expect_held(machine, again, target);
            }
            reached += ways.empty() ? 0 : 1;
        }
        EXPECT_GT(reached, 9500);
    }
}

// A smooth way of eye and roller is followed by steps that shrink with its own, on one branch.
TEST(ArmEyeInverse, FollowsASmoothWayWithoutAFlip) {
    const Machine machine = machine_file("robot_winder");
    const auto inverse = make_eye_inverse(machine);
    const auto target_at = [](double t) {
        EyeTarget target;
        target.eye_mm = {160.0 + 60.0 * std::cos(t), 30.0 * std::sin(2.0 * t), 200.0 * std::sin(t)};
        target.tangent = Vector3d(0.3 * std::cos(t), std::sin(t), std::cos(t)).normalized();
        target.binormal = target.tangent.cross(Vector3d::UnitX()).normalized();
        return target;
    };
    const auto largest_step = [&](int steps) {
        std::vector<double> q = inverse->starts(target_at(0.0), 0.0).front();
        double largest = 0.0;
        for (int i = 1; i <= steps; ++i) {
            std::vector<double> next(q.size());
            EXPECT_FALSE(inverse->solve(target_at(2.0 * kPi * i / steps), 0.0, q, next).flip);
            for (std::size_t j = 0; j < q.size(); ++j) {
                largest = std::max(largest, std::abs(next[j] - q[j]));
            }
            q = next;
        }
        return largest;
    };
    EXPECT_NEAR(largest_step(4000) / largest_step(2000), 0.5, 0.01);
}

TEST(ArmEyeInverse, StandsAbeamOfTheEyeOnItsTrack) {
    const Machine machine = machine_file("robot_track");
    const auto inverse = ArmEyeInverse::recognise(machine);
    ASSERT_TRUE(inverse && inverse->on_track());
    Draw draw(2);
    EyeTarget target = drawn_target(draw);
    for (const double height_mm : {-9000.0, -1000.0, 0.0, 700.0, 9000.0}) {
        target.eye_mm.z() = height_mm;
        std::vector<double> q(machine.axis_count(), 0.0);
        (void)inverse->solve(target, 0.0, q, q);
        EXPECT_NEAR(q[1], std::clamp(height_mm, machine.axis(1).min, machine.axis(1).max), 1e-9);
    }
}

TEST(ArmEyeInverse, LeavesOtherMachinesAlone) {
    for (const char* name : {"six_axis", "five_axis", "four_axis", "two_axis", "hobby_grbl"}) {
        EXPECT_FALSE(ArmEyeInverse::recognise(machine_file(name))) << name;
    }
    Machine askew = machine_file("robot_winder");
    askew.mandrel_chain.front().direction = Vector3d::UnitX();
    EXPECT_FALSE(ArmEyeInverse::recognise(askew));
    Machine bent_wrist = machine_file("robot_winder");  // axis 6 beside where 4 and 5 meet
    bent_wrist.eye_chain.back().point_mm.y() += 60.0;
    EXPECT_FALSE(ArmEyeInverse::recognise(bent_wrist));
    Machine short_of_one = machine_file("robot_winder");
    short_of_one.eye_chain.pop_back();
    EXPECT_FALSE(ArmEyeInverse::recognise(short_of_one));
}

}  // namespace
}  // namespace meshwind
