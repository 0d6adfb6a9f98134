// How the head twists the band: a head roll about the fibre, the rest of the machine at zero.
#include "postproc/verify/roller_check.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/machine_file.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

constexpr int kPerBlock = 20;

// Two blocks, in each of which the roll turns by `roll_rad`, and the laid band by `band_rad`.
LaidPath rolled(const Machine& machine, double roll_rad, double band_rad) {
    LaidPath laid;
    laid.joints.axis_count = machine.axis_count();
    const std::size_t roll = *machine.joint_of('A');
    for (int i = 0; i <= 2 * kPerBlock; ++i) {
        const double share = static_cast<double>(i) / kPerBlock;
        std::vector<double> row(machine.axis_count(), 0.0);
        row[roll] = share * roll_rad;
        laid.joints.joints.insert(laid.joints.joints.end(), row.begin(), row.end());
        EyePoint point;
        point.tangent = Vector3d::UnitX();
        point.binormal = Vector3d(0.0, -std::sin(share * band_rad), std::cos(share * band_rad));
        laid.samples.push_back(point);
        laid.block.push_back(i <= kPerBlock ? 1 : 2);
    }
    return laid;
}

TEST(RollerCheck, HeadThatFollowsTheBandDoesNotTwistIt) {
    const Machine machine = test::machine_file("six_axis");
    const RollerFinding found = find_roller(machine, rolled(machine, 3.0, 3.0));
    EXPECT_NEAR(found.turned_rad, 0.0, 1e-12);
    EXPECT_EQ(found.turned_over, 0U);
    EXPECT_NEAR(found.worst_twist_rad, 0.0, 1e-12);
}

TEST(RollerCheck, HalfATurnThereAndBackIsAWholeTurnOfTwist) {
    const Machine machine = test::machine_file("six_axis");
    LaidPath there = rolled(machine, kPi, 0.0);
    const std::size_t axes = machine.axis_count();
    const std::size_t roll = *machine.joint_of('A');
    for (std::size_t i = kPerBlock; i < there.samples.size(); ++i) {
        double& a = there.joints.joints[i * axes + roll];
        a = 2.0 * kPi - a;
    }
    const RollerFinding found = find_roller(machine, there);
    EXPECT_NEAR(found.turned_rad, 2.0 * kPi, 1e-9);
    EXPECT_EQ(found.turned_over, 2U);
    // The roller is a line: at the ends of the blocks it lies along the band again.
    EXPECT_NEAR(found.worst_twist_rad, 0.0, 1e-9);
}

TEST(RollerCheck, BandThatTurnsUnderAStillHeadIsTwistedAsMuch) {
    const Machine machine = test::machine_file("six_axis");
    const RollerFinding found = find_roller(machine, rolled(machine, 0.0, rad_from_deg(50.0)));
    EXPECT_NEAR(found.turned_rad, rad_from_deg(100.0), 1e-9);
    EXPECT_EQ(found.turned_over, 0U);
    EXPECT_NEAR(found.worst_twist_rad, rad_from_deg(80.0), 1e-9);
}

}  // namespace
}  // namespace meshwind
