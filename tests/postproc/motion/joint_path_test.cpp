#include "postproc/motion/joint_path.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "machines/kinematics.h"
#include "machines/machine_json.h"
#include "tests/support/synthetic_paths.h"

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

// Four axes have no Y; on strokes by central angle none is needed, and a turn of one's own cannot
// be had.
TEST(JointPath, FourAxesFollowStrokesAtAnyPolicy) {
    const Machine machine = read_machine(kSource + "/machines/four_axis.json");
    const EyePath path = test::strokes(70.0, 200.0, 2.0, 400.0, 4);
    for (const RedundancyPolicy policy :
         {RedundancyPolicy::CentralAngle, RedundancyPolicy::Hold, RedundancyPolicy::Oscillate}) {
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

// A roll that goes from 80 to 170 degrees fits between stops at 110 when it starts at -100.
TEST(JointPath, RollStartsWhereItsStopsAreNotInTheWay) {
    const Machine machine = read_machine(kSource + "/machines/hobby_grbl.json");
    EyePath path;
    for (int i = 0; i <= 90; ++i) {
        const double a = rad_from_deg(80.0 + i);
        EyePoint point;
        point.eye_mm = {60.0, 0.0, 0.0};
        point.tangent = {0.0, std::cos(a), std::sin(a)};
        point.binormal = {0.0, -std::sin(a), std::cos(a)};
        path.push_back(point);
    }
    const JointPath joints = solve_joints(machine, path, RedundancyPolicy::CentralAngle);
    EXPECT_TRUE(joints.violations.empty());
    EXPECT_TRUE(joints.notes.empty());
    EXPECT_NEAR(value(machine, joints, 0, 'Z'), rad_from_deg(-100.0), 1e-12);
    EXPECT_NEAR(value(machine, joints, 90, 'Z'), rad_from_deg(-10.0), 1e-12);
    EXPECT_LT(joints.worst_twist_rad, 1e-12);
    // 80 to 310 degrees does not fit: one flip is left, and it is told with its size.
    for (int i = 91; i <= 230; ++i) {
        const double a = rad_from_deg(80.0 + i);
        path.push_back(path.back());
        path.back().tangent = {0.0, std::cos(a), std::sin(a)};
        path.back().binormal = {0.0, -std::sin(a), std::cos(a)};
    }
    const JointPath longer = solve_joints(machine, path, RedundancyPolicy::CentralAngle);
    EXPECT_TRUE(longer.violations.empty());
    ASSERT_EQ(longer.notes.size(), 1u);
    EXPECT_EQ(longer.notes[0].kind, JointNoteKind::WristFlip);
    EXPECT_NEAR(longer.notes[0].measure, kPi, rad_from_deg(2.0));
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

// Behind the mandrel, where the eye of a helix is once it has passed a quarter turn, X would be
// negative, which this machine cannot do: the spindle follows just in time.
TEST(JointPath, HoldKeepsTheEyeInFront) {
    const Machine machine = six_axis();
    const EyePath path = test::helix(70.0, k45, 200.0, 5.0, 200);
    const JointPath joints = solve_joints(machine, path, RedundancyPolicy::Hold);
    EXPECT_TRUE(joints.violations.empty());
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const Eigen::Isometry3d eye = mandrel_from_eye(machine, joints.row(i));
        ASSERT_LT((eye.translation() - path[i].eye_mm).norm(), 1e-9);
        // 31 steps of 0.0505 rad are below a quarter turn, 32 are above.
        ASSERT_EQ(value(machine, joints, i, 'C') == value(machine, joints, 0, 'C'), i < 32);
        if (i >= 32) {
            ASSERT_NEAR(value(machine, joints, i, 'X'), 0.0, 1e-9);
            ASSERT_NEAR(value(machine, joints, i, 'Y'), 157.797338, 1e-6);
        }
    }
}

TEST(JointPath, SpindleThatStandsStillRunsIntoTheEndOfX) {
    const Machine machine = six_axis();
    const EyePath path = test::helix(70.0, k45, 200.0, 5.0, 200);
    const double first = spindle_turns(path, RedundancyPolicy::CentralAngle).front();
    const JointPath joints = solve_joints(machine, path, std::vector<double>(path.size(), first));
    for (std::size_t i = 0; i < joints.size(); ++i) {
        EXPECT_EQ(value(machine, joints, i, 'C'), value(machine, joints, 0, 'C'));
        const Eigen::Isometry3d eye = mandrel_from_eye(machine, joints.row(i));
        EXPECT_LT((eye.translation() - path[i].eye_mm).norm(), 1e-9);
    }
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

struct Play {
    RedundancyPolicy policy;
    double play_rad;
};

const std::vector<Play> kPlays = {{RedundancyPolicy::Hold, rad_from_deg(90.0)},
                                  {RedundancyPolicy::Oscillate, rad_from_deg(30.0)}};

// On the published helix the central angle goes back by 0.0505076272 rad a step: it runs ahead by
// the play, and from there on the turn follows with that lag, through any number of turns.
TEST(SpindleTurns, HelixIsFollowedWithAConstantLag) {
    const EyePath path = test::helix(70.0, k45, 200.0, 5.0, 2000);
    for (const auto& [policy, play_rad] : kPlays) {
        const std::vector<double> turns = spindle_turns(path, policy);
        for (std::size_t i = 0; i < turns.size(); ++i) {
            const double run = 0.0505076272 * static_cast<double>(i);
            ASSERT_NEAR(turns[i], -1.111176996 - std::max(run - play_rad, 0.0), 1e-6) << i;
        }
    }
}

// An eye that swings about `middle_rad`, two periods from the middle on.
EyePath orbit(double middle_rad, double amplitude_rad) {
    EyePath path;
    for (int i = 0; i <= 800; ++i) {
        const double angle = middle_rad + amplitude_rad * std::sin(i * kPi / 200.0);
        EyePoint point;
        point.eye_mm = {150.0 * std::cos(angle), 150.0 * std::sin(angle), 10.0};
        path.push_back(point);
    }
    return path;
}

TEST(SpindleTurns, OrbitWithinThePlayLeavesTheMandrelStill) {
    for (const auto& [policy, play_rad] : kPlays) {
        for (const double middle_rad : {0.0, rad_from_deg(179.0), rad_from_deg(-120.0)}) {
            const std::vector<double> turns =
                spindle_turns(orbit(middle_rad, play_rad - 0.01), policy);
            for (const double turn : turns) {
                ASSERT_NEAR(turn, -middle_rad, 1e-12);
            }
        }
    }
}

// Beyond the play it swings by the excess, and stands still on the way back until the whole play,
// to both sides, is taken up.
TEST(SpindleTurns, OrbitBeyondThePlaySwingsTheMandrelByTheExcess) {
    for (const auto& [policy, play_rad] : kPlays) {
        const double excess_rad = 0.2;
        const EyePath path = orbit(rad_from_deg(179.0), play_rad + excess_rad);
        const std::vector<double> turns = spindle_turns(path, policy);
        const double middle = -rad_from_deg(179.0);
        EXPECT_NEAR(turns[100], middle - excess_rad, 1e-12);
        EXPECT_NEAR(turns[300], middle + excess_rad, 1e-12);
        EXPECT_NEAR(turns[500], middle - excess_rad, 1e-12);
        EXPECT_NEAR(turns[700], middle + excess_rad, 1e-12);
        for (std::size_t i = 100; i < 300; ++i) {
            const double back_rad =
                (play_rad + excess_rad) * (1.0 - std::sin(static_cast<double>(i) * kPi / 200.0));
            ASSERT_NEAR(turns[i], middle - excess_rad + std::max(back_rad - 2.0 * play_rad, 0.0),
                        1e-12)
                << i;
        }
    }
}

// Where a rule puts the eye elsewhere in the machine, the play is about that place.
TEST(SpindleTurns, PlayIsAboutThePlaceOfTheEyeInTheMachine) {
    EyePath path = orbit(0.5, 2.0);
    for (const auto& [policy, play_rad] : kPlays) {
        const std::vector<double> before = spindle_turns(path, policy);
        EyePath raised = path;
        for (EyePoint& point : raised) {
            point.azimuth_rad = 0.3;
        }
        const std::vector<double> after = spindle_turns(raised, policy);
        for (std::size_t i = 0; i < path.size(); ++i) {
            ASSERT_NEAR(after[i], before[i] + 0.3, 1e-12);
        }
    }
}

TEST(JointPath, EmptyPathGivesEmptyJoints) {
    const JointPath joints = solve_joints(six_axis(), {}, RedundancyPolicy::CentralAngle);
    EXPECT_EQ(joints.size(), 0u);
}

}  // namespace
}  // namespace meshwind
