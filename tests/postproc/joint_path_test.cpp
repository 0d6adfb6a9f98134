#include "postproc/joint_path.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "machines/kinematics.h"
#include "machines/machine_json.h"
#include "tests/postproc/synthetic_paths.h"

namespace meshwind {
namespace {

const std::string kSource = MESHWIND_SOURCE_DIR;
const double k45 = rad_from_deg(45.0);

Machine six_axis() {
    return read_machine(kSource + "/machines/six_axis.json");
}

Machine five_axis() {
    return read_machine(kSource + "/data/conformance/machine/valid/five_axis_roll_only.json");
}

double value(const Machine& machine, const JointPath& joints, std::size_t point, char letter) {
    return joints.row(point)[*machine.joint_of(letter)];
}

// Published sample: R = 70, 45 degrees, L = 200, step 5. Its C counts the eye around the mandrel;
// the spindle joint here turns the mandrel, so C has the opposite sign.
TEST(JointPath, HelixStartWithTheSpindleAtZero) {
    const Machine machine = five_axis();
    const EyePath path = test::helix(70.0, k45, 200.0, 5.0, 3);
    const JointPath joints = solve_joints(machine, path, std::vector<double>(3, 0.0));
    EXPECT_NEAR(value(machine, joints, 0, 'X'), 70.0, 1e-9);
    EXPECT_NEAR(value(machine, joints, 0, 'Y'), 141.421356237, 1e-9);
    EXPECT_NEAR(value(machine, joints, 0, 'Z'), 141.421356237, 1e-9);
    EXPECT_NEAR(value(machine, joints, 0, 'A'), 0.785398163, 1e-9);
}

TEST(JointPath, HelixByCentralAngleMovesCarriageAndSpindleOnly) {
    const Machine machine = five_axis();
    const EyePath path = test::helix(70.0, k45, 200.0, 5.0, 2000);
    const JointPath joints = solve_joints(machine, path, RedundancyPolicy::CentralAngle);
    EXPECT_NEAR(value(machine, joints, 0, 'C'), -1.111176996, 1e-9);
    EXPECT_NEAR(value(machine, joints, 0, 'X'), 157.797338, 1e-6);
    EXPECT_NEAR(value(machine, joints, 0, 'Y'), 0.0, 1e-12);
    EXPECT_NEAR(value(machine, joints, 0, 'Z'), 141.421356, 1e-6);
    EXPECT_NEAR(value(machine, joints, 0, 'A'), 1.153271544, 1e-9);
    for (std::size_t i = 1; i < joints.size(); ++i) {
        const auto step = [&](char letter) {
            return value(machine, joints, i, letter) - value(machine, joints, i - 1, letter);
        };
        ASSERT_NEAR(step('X'), 0.0, 1e-10);
        ASSERT_NEAR(step('Y'), 0.0, 1e-10);
        ASSERT_NEAR(step('Z'), 3.535533906, 1e-9);
        ASSERT_NEAR(step('C'), -0.050507627, 1e-9);
        ASSERT_NEAR(step('A'), 0.0, 1e-10);
    }
    // 2000 steps are 16 turns: the angle is counted on.
    EXPECT_NEAR(value(machine, joints, 1999, 'C'), -1.111176996 - 1999 * 0.0505076272, 1e-6);
}

void expect_forward_kinematics(const Machine& machine, const EyePath& path) {
    const JointPath joints = solve_joints(machine, path, RedundancyPolicy::CentralAngle);
    ASSERT_EQ(joints.size(), path.size());
    const bool swing = machine.joint_of('B').has_value();
    for (std::size_t i = 0; i < path.size(); ++i) {
        const Eigen::Isometry3d eye = mandrel_from_eye(machine, joints.row(i));
        ASSERT_LT((eye.translation() - path[i].eye_mm).norm(), 1e-9);
        const Eigen::Vector3d roller = eye.linear() * machine.eye.roller;
        ASSERT_LT(std::abs(roller.dot(path[i].tangent)), 1e-9);
        ASSERT_TRUE(!swing || roller.cross(path[i].binormal).norm() < 1e-9);
        ASSERT_NEAR(value(machine, joints, i, 'Y'), 0.0, 1e-9);
        ASSERT_GT(value(machine, joints, i, 'X'), 0.0);
    }
    for (std::size_t i = 1; i < path.size(); ++i) {
        for (std::size_t a = 0; a < joints.axis_count; ++a) {
            ASSERT_LT(std::abs(joints.row(i)[a] - joints.row(i - 1)[a]),
                      machine.axis(a).type == AxisType::Rotary ? 0.5 : 20.0);
        }
    }
}

TEST(JointPath, RoundTripOverStrokesAndOffAxisBodies) {
    for (const Machine& machine : {six_axis(), five_axis()}) {
        expect_forward_kinematics(machine, test::strokes(70.0, 200.0, 2.0, 400.0, 4));
        expect_forward_kinematics(machine, test::elliptic_helix(3000));
    }
}

// Four axes have no Y; on strokes by central angle none is needed, and "hold" cannot be had.
TEST(JointPath, FourAxesFollowStrokesAtAnyPolicy) {
    const Machine machine = read_machine(kSource + "/machines/four_axis.json");
    const EyePath path = test::strokes(70.0, 200.0, 2.0, 400.0, 4);
    for (const RedundancyPolicy policy : {RedundancyPolicy::CentralAngle, RedundancyPolicy::Hold}) {
        const JointPath joints = solve_joints(machine, path, policy);
        EXPECT_LT(joints.worst_miss_mm, 1e-9);
        EXPECT_TRUE(joints.violations.empty());
        EXPECT_TRUE(joints.notes.empty());
        for (std::size_t i = 0; i < path.size(); ++i) {
            const Eigen::Isometry3d eye = mandrel_from_eye(machine, joints.row(i));
            ASSERT_LT((eye.translation() - path[i].eye_mm).norm(), 1e-9);
            ASSERT_LT(std::abs((eye.linear() * machine.eye.roller).dot(path[i].tangent)), 1e-9);
        }
    }
}

TEST(JointPath, FourAxesSayWhatAGivenTurnMisses) {
    const Machine machine = read_machine(kSource + "/machines/four_axis.json");
    const EyePath path = test::helix(70.0, k45, 200.0, 5.0, 50);
    std::vector<double> turns = spindle_turns(path, RedundancyPolicy::CentralAngle);
    constexpr double kOff_rad = 0.1;
    for (std::size_t i = 20; i < 30; ++i) {
        turns[i] += kOff_rad;
    }
    const JointPath joints = solve_joints(machine, path, turns);
    ASSERT_EQ(joints.notes.size(), 1u);
    EXPECT_EQ(joints.notes[0].kind, JointNoteKind::EyeOutOfReach);
    EXPECT_EQ(joints.notes[0].first, 20u);
    EXPECT_EQ(joints.notes[0].last, 29u);
    EXPECT_NEAR(joints.notes[0].measure, 157.797338 * std::sin(kOff_rad), 1e-5);
    EXPECT_EQ(joints.notes[0].measure, joints.worst_miss_mm);
}

// Published two-axis example: tube of radius 40 at 45 degrees, the eye at 58.31 from the axis; its
// regular part of 251 mm takes 359.53102 degrees of the mandrel.
TEST(JointPath, TwoAxesWindThePublishedTube) {
    const Machine machine = read_machine(kSource + "/machines/two_axis.json");
    const double reach = std::sqrt(58.31 * 58.31 - 40.0 * 40.0);  // along the tangent plane
    const double free_mm = reach / std::sin(k45);
    const double step = 251.0 / std::cos(k45) / 100.0;
    const JointPath joints = solve_joints(machine, test::helix(40.0, k45, free_mm, step, 101),
                                          RedundancyPolicy::CentralAngle);
    EXPECT_LT(joints.worst_miss_mm, 1e-9);
    const double turned = value(machine, joints, 100, 'X') - value(machine, joints, 0, 'X');
    EXPECT_NEAR(std::abs(deg_from_rad(turned)), 359.53102, 1e-4);
    EXPECT_NEAR(value(machine, joints, 0, 'Y'), reach, 1e-9);
    EXPECT_NEAR(value(machine, joints, 100, 'Y') - value(machine, joints, 0, 'Y'), 251.0, 1e-9);

    // A longer free fibre wants the eye further out than it is.
    const JointPath longer = solve_joints(machine, test::helix(40.0, k45, 80.0, step, 101),
                                          RedundancyPolicy::CentralAngle);
    ASSERT_EQ(longer.notes.size(), 1u);
    EXPECT_EQ(longer.notes[0].kind, JointNoteKind::EyeOutOfReach);
    EXPECT_NEAR(longer.worst_miss_mm, std::hypot(40.0, 80.0 * std::sin(k45)) - 58.31, 1e-9);
}

// A machine without closed form runs the same path: the head swings before it rolls.
TEST(JointPath, ChainsWithoutClosedFormAreSolvedNumerically) {
    Machine machine = six_axis();
    std::swap(machine.eye_chain[3], machine.eye_chain[4]);
    const EyePath path = test::helix(70.0, k45, 200.0, 5.0, 200);
    const JointPath joints = solve_joints(machine, path, RedundancyPolicy::CentralAngle);
    EXPECT_LT(joints.worst_miss_mm, 1e-9);
    EXPECT_LT(joints.worst_twist_rad, 1e-9);
    EXPECT_TRUE(joints.violations.empty());
    for (std::size_t i = 0; i < path.size(); ++i) {
        const Eigen::Isometry3d eye = mandrel_from_eye(machine, joints.row(i));
        ASSERT_LT((eye.translation() - path[i].eye_mm).norm(), 1e-9);
    }
}

TEST(JointPath, HoldKeepsTheSpindleStill) {
    const Machine machine = six_axis();
    const EyePath path = test::helix(70.0, k45, 200.0, 5.0, 200);
    const JointPath joints = solve_joints(machine, path, RedundancyPolicy::Hold);
    for (std::size_t i = 0; i < joints.size(); ++i) {
        EXPECT_EQ(value(machine, joints, i, 'C'), value(machine, joints, 0, 'C'));
        const Eigen::Isometry3d eye = mandrel_from_eye(machine, joints.row(i));
        EXPECT_LT((eye.translation() - path[i].eye_mm).norm(), 1e-9);
    }
    // The eye orbits the mandrel: behind it X is negative, which this machine cannot do.
    ASSERT_FALSE(joints.violations.empty());
    const LimitViolation& violation = joints.violations.front();
    EXPECT_EQ(violation.axis, 'X');
    EXPECT_EQ(violation.limit, 0.0);
    EXPECT_NEAR(violation.value, -157.797338, 0.1);
    EXPECT_LE(violation.first, violation.point);
    EXPECT_LE(violation.point, violation.last);
    EXPECT_EQ(value(machine, joints, violation.point, 'X'), violation.value);
}

TEST(JointPath, NoViolationWithinTheLimits) {
    const Machine machine = six_axis();
    const JointPath joints = solve_joints(machine, test::strokes(70.0, 200.0, 2.0, 400.0, 2),
                                          RedundancyPolicy::CentralAngle);
    EXPECT_TRUE(joints.violations.empty());
    EXPECT_TRUE(joints.notes.empty());
    EXPECT_EQ(joints.worst_twist_rad, 0.0);
}

TEST(SpindleTurns, EyeOnTheAxisKeepsTheTurn) {
    EyePath path = test::helix(70.0, k45, 200.0, 5.0, 3);
    path[1].eye_mm = {0.0, 0.0, 50.0};
    const std::vector<double> turns = spindle_turns(path, RedundancyPolicy::CentralAngle);
    EXPECT_EQ(turns[1], turns[0]);
    path[0].eye_mm = {-0.0, 0.0, 50.0};
    EXPECT_EQ(spindle_turns(path, RedundancyPolicy::CentralAngle)[0], 0.0);
    const JointPath joints = solve_joints(six_axis(), path, RedundancyPolicy::CentralAngle);
    ASSERT_EQ(joints.notes.size(), 1u);
    EXPECT_EQ(joints.notes[0].kind, JointNoteKind::EyeNearSpindleAxis);
    EXPECT_EQ(joints.notes[0].last, 1u);
}

TEST(SpindleTurns, CrossingTheAxisIsAtMostHalfATurn) {
    EyePath path(2);
    path[0].eye_mm = {100.0, 1e-3, 0.0};
    path[1].eye_mm = {-100.0, -1e-3, 0.0};
    const std::vector<double> turns = spindle_turns(path, RedundancyPolicy::CentralAngle);
    EXPECT_LE(std::abs(turns[1] - turns[0]), kPi + 1e-12);
    EXPECT_NEAR(std::abs(turns[1] - turns[0]), kPi, 1e-4);
}

TEST(JointPath, EmptyPathGivesEmptyJoints) {
    const JointPath joints = solve_joints(six_axis(), {}, RedundancyPolicy::CentralAngle);
    EXPECT_EQ(joints.size(), 0u);
}

}  // namespace
}  // namespace meshwind
