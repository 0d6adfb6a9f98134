#include "machines/kinematics.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "machines/machine_json.h"
#include "tests/support/machine_draws.h"

namespace meshwind {
namespace {

using test::Draw;

const std::string kCorpus = std::string(MESHWIND_SOURCE_DIR) + "/data/conformance/machine/valid/";

Machine six_axis() {
    return test::machine_file("six_axis");
}

Machine five_axis() {
    return read_machine(kCorpus + "five_axis_roll_only.json");
}

std::string refusal(const Machine& machine) {
    try {
        const SpindleWristInverse inverse(machine);
    } catch (const InputError& error) {
        return error.code();
    }
    return "accepted";
}

EyeTarget drawn_target(Draw& draw) {
    EyeTarget target;
    target.eye_mm = 500.0 * draw.direction();
    target.tangent = draw.direction();
    target.binormal = target.tangent.cross(draw.direction()).normalized();
    return target;
}

// Largest error of position (mm) and of the roller's direction against `across` (rad).
void expect_pose(const Machine& machine, const std::vector<double>& q, const EyeTarget& target,
                 const Eigen::Vector3d& across) {
    const Eigen::Isometry3d eye = mandrel_from_eye(machine, q);
    EXPECT_LT((eye.translation() - target.eye_mm).norm(), 1e-9);
    const Eigen::Vector3d roller = eye.linear() * machine.eye.roller;
    EXPECT_LT(roller.cross(across).norm(), 1e-9);
    EXPECT_LT(std::abs(roller.dot(target.tangent)), 1e-9);
}

void expect_round_trip(const Machine& machine, unsigned seed) {
    const SpindleWristInverse inverse(machine);
    Draw draw(seed);
    std::vector<double> q(machine.axis_count(), 0.0);
    for (int i = 0; i < 10'000; ++i) {
        const EyeTarget target = drawn_target(draw);
        // A thousand turns: the angle that a mandrel reaches in a real program.
        const double turn = draw.between(-6000.0, 6000.0);
        const WristState state = inverse.solve(target, turn, q, q);
        EXPECT_FALSE(state.held);
        EXPECT_DOUBLE_EQ(inverse.turn_rad(q), turn);
        if (inverse.has_swing()) {
            // sin(6000 rad) and its inverse lose 6000 * 2^-53 = 7e-13 of direction: 4e-10 mm at 500
            // mm.
            expect_pose(machine, q, target, target.binormal);
            EXPECT_EQ(state.twist_rad, 0.0);
        } else {
            const Eigen::AngleAxisd back(-turn, Eigen::Vector3d::UnitZ());
            const Eigen::Vector3d across =
                (back * Eigen::Vector3d::UnitX()).cross(target.tangent).normalized();
            expect_pose(machine, q, target, across);
            EXPECT_NEAR(std::cos(state.twist_rad), std::abs(across.dot(target.binormal)), 1e-9);
        }
    }
}

TEST(Kinematics, EyeMovesAreTheDifferencesOfThePose) {
    const Machine machine = six_axis();
    const std::vector<double> q{0.7, 120.0, 15.0, 230.0, 1.1, -0.4};
    const Eigen::Matrix3Xd moves = eye_moves(machine, q);
    const Eigen::Matrix3d base = base_from_mandrel(machine, q).linear();
    for (std::size_t a = 0; a < q.size(); ++a) {
        constexpr double kStep = 1e-4;  // central differences: error of its square
        std::vector<double> more = q;
        std::vector<double> less = q;
        more[a] += kStep;
        less[a] -= kStep;
        const Eigen::Vector3d difference = mandrel_from_eye(machine, more).translation() -
                                           mandrel_from_eye(machine, less).translation();
        const auto column = moves.col(static_cast<Eigen::Index>(a));
        EXPECT_LT((base * difference / (2.0 * kStep) - column).norm(), 1e-5) << a;
    }
}

TEST(SpindleWristInverse, RoundTripSixAxes) {
    expect_round_trip(six_axis(), 1);
}

TEST(SpindleWristInverse, RoundTripFiveAxes) {
    expect_round_trip(five_axis(), 2);
}

TEST(SpindleWristInverse, RoundTripOtherLettersOrderAndSigns) {
    Machine machine = read_machine(kCorpus + "other_letters_and_order.json");
    expect_round_trip(machine, 3);
    for (Axis& axis : machine.eye_chain) {
        axis.direction = -axis.direction;
    }
    machine.eye.roller = -machine.eye.roller;
    expect_round_trip(machine, 4);
    machine.eye_chain[1].direction = Eigen::Vector3d(0.6, 0.0, 0.8);  // an inclined carriage
    expect_round_trip(machine, 5);
    machine.eye.position_mm = {30.0, -20.0, 10.0};
    machine.eye_chain[3].point_mm = {-50.0, -20.0, 10.0};
    machine.eye_chain[4].point_mm = {30.0, 70.0, 10.0};
    expect_round_trip(machine, 6);
}

TEST(SpindleWristInverse, RollAndSwingFollowTheirFormula) {
    const Machine machine = six_axis();
    const double a = 0.4;
    const double b = -0.7;
    std::vector<double> q(6, 0.0);
    q[*machine.joint_of('A')] = a;
    q[*machine.joint_of('B')] = b;
    const Eigen::Isometry3d eye = base_from_eye(machine, q);
    const Eigen::Vector3d roller(std::sin(b), -std::sin(a) * std::cos(b),
                                 std::cos(a) * std::cos(b));
    EXPECT_LT((eye.linear() * machine.eye.roller - roller).norm(), 1e-15);
    const Eigen::Vector3d exit(-std::cos(b), -std::sin(a) * std::sin(b), std::cos(a) * std::sin(b));
    EXPECT_LT((eye.linear() * machine.eye.exit - exit).norm(), 1e-15);
}

TEST(SpindleWristInverse, HoopNeedsNoRoll) {
    const Machine machine = five_axis();
    const SpindleWristInverse inverse(machine);
    std::vector<double> q(5, 0.0);
    const EyeTarget target{.eye_mm = {200.0, 0.0, 30.0},
                           .tangent = Eigen::Vector3d(0.8, 0.6, 0.0),
                           .binormal = {0.0, 0.0, 1.0}};
    (void)inverse.solve(target, 0.0, q, q);
    EXPECT_EQ(q[*machine.joint_of('A')], 0.0);
    // The other winding sense: the roller is a line, so the head does not turn over.
    const EyeTarget back{.eye_mm = {200.0, 0.0, 30.0},
                         .tangent = Eigen::Vector3d(0.8, -0.6, 0.0),
                         .binormal = {0.0, 0.0, -1.0}};
    (void)inverse.solve(back, 0.0, q, q);
    EXPECT_NEAR(q[*machine.joint_of('A')], 0.0, 1e-15);
}

TEST(SpindleWristInverse, RollAddsUpOverManyTurns) {
    // Fibre that turns round a branch across the spindle: its direction circles about X.
    const Machine machine = five_axis();
    const SpindleWristInverse inverse(machine);
    std::vector<double> q(5, 0.0);
    const std::size_t roll = *machine.joint_of('A');
    for (int i = 0; i <= 1000; ++i) {
        const double angle = 0.1 * i;
        const EyeTarget target{
            .eye_mm = {300.0, 0.0, 0.0},
            .tangent = Eigen::Vector3d(0.5, std::cos(angle), std::sin(angle)).normalized(),
            .binormal = {0.0, -std::sin(angle), std::cos(angle)}};
        const WristState state = inverse.solve(target, 0.0, q, q);
        EXPECT_FALSE(state.flip);
        ASSERT_NEAR(q[roll], angle, 1e-9);
    }
}

TEST(SpindleWristInverse, SingularWristKeepsItsRollAndSaysSo) {
    for (const Machine& machine : {six_axis(), five_axis()}) {
        const SpindleWristInverse inverse(machine);
        std::vector<double> q(machine.axis_count(), 0.0);
        const std::size_t roll = *machine.joint_of('A');
        q[roll] = 1.25;
        const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
        const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
        // With A and B the roller along X is singular, with A alone the fibre along X.
        const EyeTarget target{.eye_mm = {300.0, 0.0, 0.0},
                               .tangent = inverse.has_swing() ? y : x,
                               .binormal = inverse.has_swing() ? x : y};
        const WristState state = inverse.solve(target, 0.0, q, q);
        EXPECT_TRUE(state.held);
        EXPECT_EQ(state.singular_sine, 0.0);
        EXPECT_EQ(q[roll], 1.25);
        EXPECT_LT((mandrel_from_eye(machine, q).translation() - target.eye_mm).norm(), 1e-9);
    }
}

TEST(SpindleWristInverse, PassesThroughTheSingularPoseWithoutTurningTheHeadOver) {
    // The binormal swings through X in the plane z-x: B runs past 90 degrees, A stands still.
    const Machine machine = six_axis();
    const SpindleWristInverse inverse(machine);
    std::vector<double> q(6, 0.0);
    for (int i = 0; i <= 95; ++i) {
        const double b = rad_from_deg(i);
        const EyeTarget target{.eye_mm = {300.0, 0.0, 0.0},
                               .tangent = {0.0, 1.0, 0.0},
                               .binormal = {std::sin(b), 0.0, std::cos(b)}};
        const WristState state = inverse.solve(target, 0.0, q, q);
        EXPECT_FALSE(state.flip);
        EXPECT_NEAR(q[*machine.joint_of('A')], 0.0, 1e-12);
        EXPECT_NEAR(q[*machine.joint_of('B')], b, 1e-12);
    }
}

TEST(SpindleWristInverse, PrefersSolutionsWithinTheLimits) {
    Machine machine = five_axis();
    Axis& roll = machine.eye_chain[3];
    roll.min = rad_from_deg(-80.0);
    roll.max = rad_from_deg(80.0);
    const SpindleWristInverse inverse(machine);
    std::vector<double> q(5, 0.0);
    q[4] = rad_from_deg(75.0);
    const double a = rad_from_deg(110.0);  // 35 degrees on, beyond the stop
    const EyeTarget target{.eye_mm = {300.0, 0.0, 0.0},
                           .tangent = {0.0, std::cos(a), std::sin(a)},
                           .binormal = {1.0, 0.0, 0.0}};
    const WristState state = inverse.solve(target, 0.0, q, q);
    EXPECT_NEAR(q[4], rad_from_deg(-70.0), 1e-12);  // the same roller, turned over
    EXPECT_TRUE(state.flip);
}

TEST(SpindleWristInverse, NamesWhatItCannotDo) {
    EXPECT_EQ(refusal(read_machine(kCorpus + "six_revolute_robot.json")), "machine.missing_axis");
    Machine machine = six_axis();
    machine.eye_chain[4].direction = Eigen::Vector3d::UnitZ();
    EXPECT_EQ(refusal(machine), "machine.unsupported_chain");
    machine = six_axis();
    machine.eye_chain[3].point_mm = {0.0, 1.0, 0.0};
    EXPECT_EQ(refusal(machine), "machine.unsupported_chain");
    machine = six_axis();
    machine.eye_chain[0].direction = Eigen::Vector3d::UnitY();
    EXPECT_EQ(refusal(machine), "machine.unsupported_chain");
    machine = six_axis();
    machine.eye_chain.erase(machine.eye_chain.begin(), machine.eye_chain.begin() + 3);
    EXPECT_EQ(refusal(machine), "machine.missing_axis");
    machine = six_axis();
    machine.mount = MandrelMount{.origin_mm = {0.0, 1.0, 0.0}};
    EXPECT_EQ(refusal(machine), "machine.unsupported_chain");
    machine = six_axis();
    machine.mandrel_chain[0].point_mm = {1.0, 0.0, 0.0};
    EXPECT_EQ(refusal(machine), "machine.unsupported_chain");
    machine = six_axis();
    machine.eye.roller = Eigen::Vector3d::UnitY();
    EXPECT_EQ(refusal(machine), "machine.unsupported_chain");
}

TEST(Kinematics, RevoluteRobotTurnsAboutItsPoints) {
    const Machine machine = read_machine(kCorpus + "six_revolute_robot.json");
    std::vector<double> q(machine.axis_count(), 0.0);
    EXPECT_LT((base_from_eye(machine, q).translation() - Eigen::Vector3d(600, 0, 900)).norm(),
              1e-12);
    q[2] = 0.5 * kPi;  // shoulder at z = 400 about +Y: (600, 500) above it becomes (500, -600)
    EXPECT_LT((base_from_eye(machine, q).translation() - Eigen::Vector3d(500, 0, -200)).norm(),
              1e-9);
    const Eigen::Isometry3d elbow = base_from_link(machine, q, 'Q');
    EXPECT_LT((elbow * Eigen::Vector3d(0, 0, 400) - Eigen::Vector3d(0, 0, 400)).norm(), 1e-12);
}

TEST(Kinematics, MandrelFrameTurnsWithTheSpindle) {
    const Machine machine = six_axis();
    std::vector<double> q(6, 0.0);
    q[0] = 0.5 * kPi;
    q[*machine.joint_of('X')] = 100.0;
    // The eye stays at +X; the mandrel has turned by +90 degrees, so it sees the eye at -Y.
    EXPECT_LT((mandrel_from_eye(machine, q).translation() - Eigen::Vector3d(0, -100, 0)).norm(),
              1e-12);
}

}  // namespace
}  // namespace meshwind
