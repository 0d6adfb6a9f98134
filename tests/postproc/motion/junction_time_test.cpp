#include "postproc/motion/junction_time.h"

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "postproc/nc/nc_dialects.h"
#include "tests/support/machine_file.h"

namespace meshwind {
namespace {

double total_s(const Machine& machine, const BlockList& list, const JunctionPlanner& planner) {
    const std::vector<double> times_s = junction_times_s(machine, list, planner);
    return std::accumulate(times_s.begin(), times_s.end(), 0.0);
}

// Blocks from (0, 0, 0) on, each with the same feed. \param ways X mm and Y deg of each
BlockList blocks(const Machine& machine, const std::vector<std::pair<double, double>>& ways,
                 double feed_per_s) {
    BlockList list;
    for (std::size_t a = 0; a < machine.axis_count(); ++a) {
        const Axis& axis = machine.axis(a);
        list.axes.push_back({axis.letter, axis.type, axis.resolution_nano});
    }
    const std::size_t x = *machine.joint_of('X');
    const std::size_t y = *machine.joint_of('Y');
    list.blocks.emplace_back();
    list.nano.assign(machine.axis_count(), 0);
    for (const auto& [by_x, by_y] : ways) {
        list.blocks.push_back({.duration_s = std::hypot(by_x, by_y) / feed_per_s});
        for (std::size_t a = 0; a < machine.axis_count(); ++a) {
            const double by = a == x ? by_x : a == y ? by_y : 0.0;
            list.nano.push_back(*(list.nano.end() - static_cast<long>(machine.axis_count())) +
                                std::llround(by * 1e9));
        }
    }
    return list;
}

// Carriage of the hobby machine, mm/s^2, and its spindle, deg/s^2.
constexpr double kX = 500.0;
constexpr double kY = 720.0;

TEST(JunctionTimes, OneBlockSpeedsUpAndSlowsDown) {
    const Machine machine = test::machine_file("hobby_grbl");
    // 100 mm/s is reached in 10 mm.
    EXPECT_NEAR(total_s(machine, blocks(machine, {{60.0, 0.0}}, 100.0), {}),
                2.0 * 100.0 / kX + 40.0 / 100.0, 1e-9);
    // It is not reached in 8 mm.
    EXPECT_NEAR(total_s(machine, blocks(machine, {{8.0, 0.0}}, 100.0), {}),
                2.0 * std::sqrt(8.0 / kX), 1e-9);
}

TEST(JunctionTimes, StraightOnNothingIsLostAsFarAsIsLookedAhead) {
    const Machine machine = test::machine_file("hobby_grbl");
    const std::vector<std::pair<double, double>> short_ones(50, {2.0, 0.0});
    const double whole_s = total_s(machine, blocks(machine, {{100.0, 0.0}}, 100.0), {});
    EXPECT_NEAR(total_s(machine, blocks(machine, short_ones, 100.0), {.blocks = 15}), whole_s,
                1e-9);
    // Of two blocks it must be able to stop within the second: no more than sqrt(2 * 500 * 2).
    const double slow = std::sqrt(2.0 * kX * 2.0);
    EXPECT_GT(total_s(machine, blocks(machine, short_ones, 100.0), {.blocks = 2}), 90.0 / slow);
}

TEST(JunctionTimes, CornerIsPassedWithTheSpeedOfItsArc) {
    const Machine machine = test::machine_file("hobby_grbl");
    constexpr double kDeviation = 0.05;
    // A right angle in X and Y: the bisector is slanted by 45 degrees, and X has least to give.
    const double half_sine = std::sqrt(0.5);
    const double corner_squared = kX / half_sine * kDeviation * half_sine / (1.0 - half_sine);
    const auto half_s = [&](double a) {
        const double speed = 80.0;
        const double ramps = (2.0 * speed * speed - corner_squared) / (2.0 * a);
        return (2.0 * speed - std::sqrt(corner_squared)) / a + (100.0 - ramps) / speed;
    };
    EXPECT_NEAR(total_s(machine, blocks(machine, {{100.0, 0.0}, {0.0, 100.0}}, 80.0),
                        {.deviation_mm = kDeviation}),
                half_s(kX) + half_s(kY), 1e-9);
    // Back on the same way it stands.
    const double once_s = total_s(machine, blocks(machine, {{100.0, 0.0}}, 80.0), {});
    EXPECT_NEAR(total_s(machine, blocks(machine, {{100.0, 0.0}, {-100.0, 0.0}}, 80.0), {}),
                2.0 * once_s, 1e-9);
}

TEST(JunctionTimes, AreThoseOfTheFirmware) {
    // Measured on GRBL 1.1h (gnea/grbl bfb67f0) itself, its stepper interrupt called tick by tick:
    // 80 steps a mm, 26.7 a degree, rates and accelerations of the machine file. Its times have the
    // way to the start besides.
    constexpr std::array<std::pair<double, double>, 5> kMeasured = {
        {{0.01, 454.1}, {0.02, 409.3}, {0.05, 385.3}, {0.1, 378.0}, {0.3, 369.6}}};
    constexpr double kApproach_s = 0.5;
    const Machine machine = test::machine_file("hobby_grbl");
    const std::string file = std::string(MESHWIND_SOURCE_DIR) + "/data/programs/hobby_pipe.gcode";
    std::ifstream stream(file);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const BlockList program = Grbl().read(text, file, machine);
    EXPECT_NEAR(program.duration_s(), 367.7, 0.1);
    for (const auto& [deviation_mm, measured_s] : kMeasured) {
        const double ours_s = total_s(machine, program, {.deviation_mm = deviation_mm});
        EXPECT_LT(ours_s, measured_s) << deviation_mm;
        EXPECT_GT(ours_s, measured_s - kApproach_s) << deviation_mm;
    }
}

}  // namespace
}  // namespace meshwind
