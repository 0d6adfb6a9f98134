#include "machines/eye_range.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "machines/kinematics.h"
#include "machines/machine_json.h"

namespace meshwind {
namespace {

constexpr double kDrawn_mm = 5000.0;  // where an axis has no end
constexpr double kRounding_mm = 1e-9;

Machine shipped(const std::string& name) {
    return read_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/" + name + ".json");
}

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
        expect_holds(shipped(name), 1);
    }
}

TEST(EyeRange, HoldsEveryEyeOfMachinesWithOtherEndsMountsAndSlantedAxes) {
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<double> end(-800.0, 800.0);
    for (unsigned draw = 0; draw < 40; ++draw) {
        Machine machine = shipped(draw % 2 == 0 ? "six_axis" : "four_axis");
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
    const std::optional<EyeRange> four = eye_range(shipped("four_axis"));
    ASSERT_TRUE(four);
    EXPECT_DOUBLE_EQ(four->low_mm, -1500.0);
    EXPECT_DOUBLE_EQ(four->high_mm, 1500.0);
    EXPECT_DOUBLE_EQ(four->nearest_mm, 0.0);
    EXPECT_DOUBLE_EQ(four->farthest_mm, 800.0);
    EXPECT_EQ(four->along, "Z");
    EXPECT_EQ(four->across, "X");
    const std::optional<EyeRange> hobby = eye_range(shipped("hobby_grbl"));
    ASSERT_TRUE(hobby);
    EXPECT_DOUBLE_EQ(hobby->nearest_mm, 60.0);
    EXPECT_DOUBLE_EQ(hobby->farthest_mm, 60.0);
    EXPECT_EQ(hobby->along, "X");
    EXPECT_EQ(hobby->across, "");
    EXPECT_FALSE(eye_range(shipped("robot_kr16")));
}

// What the carriage reads is told in its own mm.
TEST(EyeRange, TurnsHeightsIntoWhatTheCarriageReads) {
    Machine machine = shipped("four_axis");
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
