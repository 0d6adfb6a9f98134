// The main job on a robot that holds the eye.
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "machines/kinematics.h"
#include "pipeline/wind.h"
#include "tests/support/run_checks.h"
#include "tests/support/small_pipe.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using test::check_of;
using test::failed_checks;

// More in one step is a flip (machines/pose_inverse.h).
constexpr double kFlip_rad = 0.5 * kPi;

// Six angles in steps of 0.001 deg.
constexpr double kRounded = 6.0 * rad_from_deg(0.0005);

// Plan, program and its proof are as on a winder; block by block the head is square to the spindle,
// and the arm stays on one branch.
void expect_wound(const std::string& name, const Job& job) {
    SCOPED_TRACE(name);
    const Machine machine = test::shipped(name);
    const meshwind::Run run = wind(test::small_pipe(), machine, job);
    EXPECT_EQ(failed_checks(run), std::vector<std::string>{});
    EXPECT_TRUE(run.usable);
    ASSERT_EQ(run.layers.size(), 1U);
    ASSERT_EQ(run.layers.front().programs.size(), 1U);
    const JointPath joints = joint_path(run.layers.front().programs.front().made.blocks);
    ASSERT_GT(joints.size(), 100U);
    const std::size_t first = machine.axis_count() - 6;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const std::span<const double> row = joints.row(i);
        const Eigen::Isometry3d eye = base_from_eye(machine, row);
        ASSERT_LT((eye.linear() * machine.eye.exit + Vector3d::UnitX()).norm(), kRounded);
        for (std::size_t a = first; i > 0 && a < row.size(); ++a) {
            ASSERT_LT(std::abs(row[a] - joints.row(i - 1)[a]), kFlip_rad) << i;
        }
    }
    // The band against the roller, by the plan's own directions at the ends of blocks.
    double twist_deg = 0.0;
    const WoundLayer& layer = run.layers.front();
    const BlockList& blocks = layer.programs.front().made.blocks;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const Block& block = blocks.blocks[i];
        const PathPoint& at = layer.plan.pieces[static_cast<std::size_t>(block.piece)]
                                  .path[static_cast<std::size_t>(block.point)];
        const Vector3d band = at.tangent.cross(at.normal).normalized();
        const Vector3d roller =
            mandrel_from_eye(machine, joints.row(i)).linear() * machine.eye.roller;
        twist_deg += deg_from_rad(std::acos(std::min(1.0, std::abs(roller.dot(band)))));
    }
    twist_deg /= static_cast<double>(joints.size());
    EXPECT_GT(twist_deg, 1.0);
    EXPECT_NEAR(check_of(run, "roller").numbers.at("mean_twist_deg"), twist_deg, 0.3);
    // The plan is the part's, not the machine's.
    const meshwind::Run other = wind(test::small_pipe(), test::shipped("six_axis"), job);
    EXPECT_EQ(run.layers.front().plan.courses, other.layers.front().plan.courses);
    EXPECT_NEAR(check_of(run, "coverage").numbers.at("fraction"),
                check_of(other, "coverage").numbers.at("fraction"), 1e-12);
    EXPECT_LT(check_of(other, "roller").numbers.at("mean_twist_deg"), 0.5);
}

TEST(Robot, WindsAPipe) {
    expect_wound("robot_winder", test::quick_job());
    expect_wound("robot_track", test::quick_job());
}

TEST(Robot, ChoosesTheMotionOfLeastTime) {
    const Machine machine = test::shipped("robot_winder");
    const auto duration_s = [&](const Job& job) {
        const meshwind::Run run = wind(test::small_pipe(), machine, job);
        EXPECT_EQ(failed_checks(run), std::vector<std::string>{});
        return run.layers.front().duration_s();
    };
    EXPECT_LT(duration_s(test::pipe_job()), duration_s(test::quick_job()));
}

}  // namespace
}  // namespace meshwind
