#include "postproc/ringhead/carried_path.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "machines/kinematics.h"
#include "machines/machine_json.h"
#include "tests/support/l_frame.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

class CarriedPath : public testing::Test {
protected:
    Machine machine_ = read_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/robot_kr16.json");
    const RingHead head_ = test::l_frame_head();
    const FrameAxis axis_ = test::l_frame(10.0);
    const CarryPoints points_ = choose_carry_points(head_, axis_, {});

    [[nodiscard]] std::vector<CarriedSample> samples() const {
        std::vector<Isometry3d> poses;
        for (const double s : points_.s_mm) {
            poses.push_back(carried_pose(head_, axis_.at(s)));
        }
        return sample_moves(points_.s_mm, poses);
    }

    void set_range(char letter, double least_deg, double most_deg) {
        for (Axis& axis : machine_.mandrel_chain) {
            if (axis.letter == letter) {
                axis.min = rad_from_deg(least_deg);
                axis.max = rad_from_deg(most_deg);
            }
        }
    }
};

TEST_F(CarriedPath, MachineFileStandsForTheHeadOfThePaper) {
    EXPECT_LT((machine_.eye.position_mm - head_.centre_mm).norm(), 1e-12);
    EXPECT_LT((machine_.eye.exit - head_.direction).norm(), 1e-12);
    EXPECT_LT((machine_.eye.roller - head_.reference).norm(), 1e-12);
}

TEST_F(CarriedPath, SamplesAreNearAndEndAtThePoints) {
    const std::vector<CarriedSample> found = samples();
    EXPECT_EQ(found.back().move, points_.s_mm.size() - 1);
    for (std::size_t i = 1; i < found.size(); ++i) {
        ASSERT_LE((found[i].pose.translation() - found[i - 1].pose.translation()).norm(),
                  kSampleWay_mm + 1e-9);
        ASSERT_LE(turn_between(found[i - 1].pose, found[i].pose), kSampleTurn_rad + 1e-7);
        ASSERT_GT(found[i].s_mm, found[i - 1].s_mm);
        if (found[i].share == 1.0) {
            ASSERT_EQ(found[i].s_mm, points_.s_mm[found[i].move]);
        }
    }
}

TEST_F(CarriedPath, ForwardKinematicsHasTheExactFrameInTheHead) {
    Isometry3d tool = Isometry3d::Identity();
    tool.translation() = Vector3d(20.0, -10.0, 60.0);
    tool.linear() = EulerZyx{0.3, -0.2, 0.1}.matrix();
    for (const Isometry3d& mounted : {Isometry3d(Isometry3d::Identity()), tool}) {
        const std::vector<CarriedSample> all = samples();
        const CarriedJoints joints = follow_samples(machine_, all, mounted);
        ASSERT_TRUE(joints.holds());
        EXPECT_GT(joints.singular, 0.1);
        double worst_mm = 0.0;
        double worst_rad = 0.0;
        double step_deg = 0.0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto row = joints.path.row(i);
            const Isometry3d mandrel = base_from_mandrel(machine_, row) * mounted;
            const AxisFrame exact = test::l_frame_at(all[i].s_mm);
            worst_mm = std::max(worst_mm, (mandrel * exact.point_mm - head_.centre_mm).norm());
            worst_rad =
                std::max(worst_rad, (mandrel.linear() * exact.tangent - head_.direction).norm());
            for (std::size_t a = 0; a < 6; ++a) {
                ASSERT_GE(row[a], machine_.axis(a).min);
                ASSERT_LE(row[a], machine_.axis(a).max);
                if (i > 0) {
                    step_deg = std::max(step_deg,
                                        std::abs(deg_from_rad(row[a] - joints.path.row(i - 1)[a])));
                }
            }
        }
        EXPECT_LT(worst_mm, 0.2);  // the tolerance of the moves
        EXPECT_LT(worst_rad, rad_from_deg(0.2));
        EXPECT_LT(step_deg, 3.0) << "continuous: half a degree of the frame is little of an axis";
    }
}

TEST_F(CarriedPath, TakesAnotherWayWhereTheFirstIsBeyondATravel) {
    const std::vector<CarriedSample> all = samples();
    const CarriedJoints first = follow_samples(machine_, all, Isometry3d::Identity());
    ASSERT_TRUE(first.holds());
    set_range('D', -110.0, 110.0);  // A4: the other wrist needs -99 to 104 deg
    const CarriedJoints other = follow_samples(machine_, all, Isometry3d::Identity());
    EXPECT_TRUE(other.holds());
    EXPECT_GT(std::abs(other.path.row(0)[3] - first.path.row(0)[3]), rad_from_deg(100.0));
    set_range('D', -80.0, 80.0);
    const CarriedJoints none = follow_samples(machine_, all, Isometry3d::Identity());
    EXPECT_FALSE(none.holds());
    EXPECT_TRUE(none.reached());
}

TEST_F(CarriedPath, SaysHowMuchIsOutOfReach) {
    Isometry3d tool = Isometry3d::Identity();
    tool.translation().x() = 3000.0;
    const CarriedJoints joints = follow_samples(machine_, samples(), tool);
    EXPECT_FALSE(joints.reached());
    EXPECT_GT(joints.residual_mm, 1.0);
}

TEST_F(CarriedPath, PassesAsFastAsAskedWhereTheAxesLetIt) {
    const std::vector<CarriedSample> all = samples();
    const CarriedJoints joints = follow_samples(machine_, all, Isometry3d::Identity());
    for (const double speed : {5.0, 20.0, 400.0}) {
        const TimedPath time = time_moves(machine_, all, joints, speed);
        ASSERT_EQ(time.step_s.size(), points_.s_mm.size());
        double fastest = 0.0;
        for (std::size_t i = 1; i < time.step_s.size(); ++i) {
            const double passage = (points_.s_mm[i] - points_.s_mm[i - 1]) / time.step_s[i];
            ASSERT_LE(passage, speed * (1.0 + 1e-9));
            fastest = std::max(fastest, passage);
        }
        const AxisLoads loads = move_loads(machine_, all, joints, time.step_s);
        EXPECT_LE(loads.velocity.ratio, 1.0 + 1e-9);
        EXPECT_LE(loads.acceleration.ratio, 1.0 + 1e-4);
        const double even_s = test::kFrame_mm / speed;
        if (speed < 10.0) {
            EXPECT_NEAR(time.duration_s, even_s, 0.05 + time.ramp_s);
        } else if (speed > 100.0) {
            EXPECT_GT(time.duration_s, 1.1 * even_s);  // 115 mm/s is all that the bend allows
        }
        EXPECT_GT(fastest, 0.5 * std::min(speed, 115.0));
    }
}

TEST_F(CarriedPath, LoadsAreThoseOfTheFastestPiece) {
    const std::vector<CarriedSample> all = samples();
    const CarriedJoints joints = follow_samples(machine_, all, Isometry3d::Identity());
    std::vector<double> duration_s(points_.s_mm.size(), 1.0);
    duration_s.front() = 0.0;
    const AxisLoads loads = move_loads(machine_, all, joints, duration_s);
    double ratio = 0.0;
    for (std::size_t i = 1; i < all.size(); ++i) {
        const double share =
            all[i].share - (all[i - 1].move == all[i].move ? all[i - 1].share : 0.0);
        for (std::size_t a = 0; a < 6; ++a) {
            ratio = std::max(ratio, std::abs(joints.path.row(i)[a] - joints.path.row(i - 1)[a]) /
                                        share / machine_.axis(a).velocity);
        }
    }
    EXPECT_NEAR(loads.velocity.ratio, ratio, 1e-12);
    std::vector<double> half = duration_s;
    for (double& step : half) {
        step *= 0.5;
    }
    EXPECT_NEAR(move_loads(machine_, all, joints, half).velocity.ratio, 2.0 * ratio, 1e-12);
}

TEST_F(CarriedPath, ClearanceIsThatOfABallBesideTheHead) {
    // While the straight arm passes the head, nothing of the frame is nearer to a body below it.
    machine_.bodies = {
        {std::nullopt, Capsule{{-1000.0, 1070.0, 900.0}, {-1000.0, 1070.0, 800.0}, 30.0}},
        {'F', Capsule{{0, 0, 0}, {0, 0, 1}, 1000.0}}};  // on a link: not looked at
    const std::vector<CarriedSample> straight = {
        {0, 1.0, 100.0, carried_pose(head_, axis_.at(100.0))},
        {1, 1.0, 101.0, carried_pose(head_, axis_.at(101.0))}};
    const auto found = frame_clearance(machine_, axis_, straight, 20.0);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->body, 0u);
    // 90 mm from axis to end of the capsule, two radii, half a step of 1 mm, the sag of the bend
    EXPECT_LE(found->least_mm, 90.0 - 50.0 - 0.5);
    EXPECT_GT(found->least_mm, 90.0 - 50.0 - 0.5 - 0.5);
    machine_.bodies.clear();
    EXPECT_FALSE(frame_clearance(machine_, axis_, straight, 20.0));
}

}  // namespace
}  // namespace meshwind
