#include "machines/eye_range.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "machines/arm_eye_inverse.h"
#include "machines/kinematics.h"
#include "tests/support/machine_draws.h"

namespace meshwind {
namespace {

constexpr double kDrawn_mm = 5000.0;  // where an axis has no end
constexpr double kRounding_mm = 1e-9;

using test::machine_file;

// Eyes of random joints within the limits, every third joint at an end.
std::vector<Eigen::Vector3d> drawn_eyes(const Machine& machine, unsigned seed) {
    std::mt19937_64 engine(seed);
    std::vector<Eigen::Vector3d> eyes;
    for (int draw = 0; draw < 2000; ++draw) {
        std::vector<double> joints(machine.axis_count(), 0.0);
        for (std::size_t j = 0; j < joints.size(); ++j) {
            const double low = std::max(machine.axis(j).min, -kDrawn_mm);
            const double high = std::min(machine.axis(j).max, kDrawn_mm);
            const double share = std::uniform_real_distribution<double>(-0.5, 1.5)(engine);
            joints[j] = low + std::clamp(share, 0.0, 1.0) * (high - low);
        }
        eyes.push_back(mandrel_from_eye(machine, joints).translation());
    }
    return eyes;
}

void expect_holds(const Machine& machine, unsigned seed) {
    const std::optional<EyeRange> range = eye_range(machine);
    ASSERT_TRUE(range);
    for (const Eigen::Vector3d& eye : drawn_eyes(machine, seed)) {
        EXPECT_GE(eye.z(), range->low_mm - kRounding_mm);
        EXPECT_LE(eye.z(), range->high_mm + kRounding_mm);
        EXPECT_GE(eye.head<2>().norm(), range->nearest_mm - kRounding_mm);
        EXPECT_LE(eye.head<2>().norm(), range->farthest_mm + kRounding_mm);
    }
}

TEST(EyeRange, HoldsEveryEyeOfTheShippedMachines) {
    for (const char* name : {"six_axis", "five_axis", "four_axis", "hobby_grbl", "two_axis"}) {
        SCOPED_TRACE(name);
        expect_holds(machine_file(name), 1);
    }
}

TEST(EyeRange, HoldsEveryEyeOfMachinesWithOtherEndsMountsAndSlantedAxes) {
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<double> end(-800.0, 800.0);
    for (unsigned draw = 0; draw < 40; ++draw) {
        Machine machine = machine_file(draw % 2 == 0 ? "six_axis" : "four_axis");
        for (Axis& axis : machine.eye_chain) {
            if (axis.type == AxisType::Linear) {
                const double a = end(engine);
                const double b = end(engine);
                axis.min = std::min(a, b);
                axis.max = std::max(a, b) + 1.0;
            }
        }
        if (draw % 4 == 0) {
            machine.eye_chain[0].direction = Eigen::Vector3d(0.1, 0.2, 1.0).normalized();
        }
        machine.mount = MandrelMount{};
        machine.mount->origin_mm.z() = end(engine);
        SCOPED_TRACE(draw);
        expect_holds(machine, draw);
    }
}

TEST(EyeRange, HasTheEndsThatTheFileNames) {
    const std::optional<EyeRange> four = eye_range(machine_file("four_axis"));
    ASSERT_TRUE(four);
    EXPECT_DOUBLE_EQ(four->low_mm, -1500.0);
    EXPECT_DOUBLE_EQ(four->high_mm, 1500.0);
    EXPECT_DOUBLE_EQ(four->nearest_mm, 0.0);
    EXPECT_DOUBLE_EQ(four->farthest_mm, 800.0);
    EXPECT_EQ(four->along, "Z");
    EXPECT_EQ(four->across, "X");
    const std::optional<EyeRange> hobby = eye_range(machine_file("hobby_grbl"));
    ASSERT_TRUE(hobby);
    EXPECT_DOUBLE_EQ(hobby->nearest_mm, 60.0);
    EXPECT_DOUBLE_EQ(hobby->farthest_mm, 60.0);
    EXPECT_EQ(hobby->along, "X");
    EXPECT_EQ(hobby->across, "");
    EXPECT_FALSE(eye_range(machine_file("robot_kr16")));
}

// Its reach: the wrist is on a sphere about the shoulder at most, and the head leads on by 358 mm.
TEST(EyeRange, HoldsWhatARobotReaches) {
    for (const char* name : {"robot_winder", "robot_track"}) {
        SCOPED_TRACE(name);
        const Machine machine = machine_file(name);
        const auto arm = ArmEyeInverse::recognise(machine);
        const auto range = eye_range(machine);
        ASSERT_TRUE(arm && range);
        std::mt19937_64 engine(5);
        std::uniform_real_distribution<double> across(-1000.0, 1000.0);
        std::uniform_real_distribution<double> along(-5000.0, 5000.0);
        int reached = 0;
        for (int draw = 0; draw < 20000; ++draw) {
            const Eigen::Vector3d eye(std::abs(across(engine)), across(engine), along(engine));
            if (std::abs(eye.y()) > std::sqrt(3.0) * eye.x() || !arm->reaches(eye)) {
                continue;
            }
            ++reached;
            EXPECT_GE(eye.z(), range->low_mm);
            EXPECT_LE(eye.z(), range->high_mm);
            EXPECT_GE(eye.head<2>().norm(), range->nearest_mm);
            EXPECT_LE(eye.head<2>().norm(), range->farthest_mm);
        }
        EXPECT_GT(reached, 500);
    }
    const double shoulder_to_wrist_mm = 680.0 + std::hypot(670.0, 35.0);
    EXPECT_LT(eye_range(machine_file("robot_winder"))->high_mm,
              260.0 + shoulder_to_wrist_mm + 160.0);
    EXPECT_NEAR(eye_range(machine_file("robot_track"))->high_mm,
                eye_range(machine_file("robot_winder"))->high_mm + 3000.0, 1e-9);
}

// What the carriage reads is told in its own mm.
TEST(EyeRange, TurnsHeightsIntoWhatTheCarriageReads) {
    Machine machine = machine_file("four_axis");
    machine.eye_chain[0].direction = -Eigen::Vector3d::UnitZ();
    machine.mount = MandrelMount{};
    machine.mount->origin_mm.z() = 100.0;
    const std::optional<EyeRange> range = eye_range(machine);
    ASSERT_TRUE(range);
    // Mandrel height 50 is machine height 150.
    EXPECT_DOUBLE_EQ(range->along_zero_mm + range->along_scale * 50.0, -150.0);
}

}  // namespace
}  // namespace meshwind
