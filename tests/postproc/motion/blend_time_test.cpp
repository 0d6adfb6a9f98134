// Against the seconds that LinuxCNC 2.9's own planner took, counted in cycles of its servo thread
// (tests/tools/linuxcnc_time.py), and closed forms.
#include "postproc/motion/blend_time.h"

#include <cmath>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include "core/text/text_file.h"
#include "core/units.h"
#include "postproc/robot/dialects.h"
#include "tests/support/block_lists.h"
#include "tests/support/machine_file.h"

namespace meshwind {
namespace {

double sum_s(const Machine& machine, const BlockList& list, const BlendPlanner& planner) {
    const std::vector<double> times_s = blend_times_s(machine, list, planner);
    return std::accumulate(times_s.begin(), times_s.end(), 0.0);
}

BlockList program(const std::string& file, const Machine& machine) {
    const std::string name = std::string(MESHWIND_SOURCE_DIR) + "/data/programs/" + file;
    return make_dialect("linuxcnc")->read(read_text_file(name), file, machine);
}

// A pipe of R 30 with 484 blocks on six axes, and a vessel with subprograms on four.
TEST(BlendTime, IsThatOfLinuxCnc) {
    const Machine six = test::machine_file("six_axis");
    Machine quick = six;
    for (std::vector<Axis>* const chain : {&quick.mandrel_chain, &quick.eye_chain}) {
        for (Axis& axis : *chain) {
            axis.acceleration *= 4.0;
        }
    }
    const BlockList pipe = program("linuxcnc_pipe.ngc", six);
    EXPECT_NEAR(pipe.duration_s(), 18.91, 0.01);  // what its F say
    constexpr double kWithin = 0.03;
    EXPECT_NEAR(sum_s(six, pipe, {.corner_mm = 2.0}), 77.348, kWithin * 77.348);
    EXPECT_NEAR(sum_s(six, pipe, {}), 77.347, kWithin * 77.347);
    EXPECT_NEAR(sum_s(six, pipe, {.corner_mm = 0.3}), 78.823, kWithin * 78.823);
    EXPECT_NEAR(sum_s(six, pipe, {.corner_mm = 0.05}), 102.562, kWithin * 102.562);
    EXPECT_NEAR(sum_s(six, pipe, {.stops = true}), 102.505, kWithin * 102.505);
    EXPECT_NEAR(sum_s(quick, pipe, {.corner_mm = 2.0}), 38.730, kWithin * 38.730);
    const Machine four = test::machine_file("four_axis");
    EXPECT_NEAR(sum_s(four, program("linuxcnc_vessel.ngc", four), {.corner_mm = 2.0}), 170.332,
                kWithin * 170.332);
}

// n alike blocks of a turning axis that ask for more speed than they reach: each takes
// sqrt(2 L / a), and the last one slows down to rest.
TEST(BlendTime, OfAlikeBlocksIsThatOfTheirLength) {
    const Machine machine = test::machine_file("six_axis");
    const double a = deg_from_rad(machine.axis(0).acceleration);
    BlockList list = test::empty_list(machine);
    test::add(list, {0, 0, 0, 0, 0, 0}, 0.0);
    constexpr int kBlocks = 200;
    constexpr double kDeg = 10.0;
    for (int i = 1; i <= kBlocks; ++i) {
        test::add(list, {i * 10'000, 0, 0, 0, 0, 0}, 0.02);
    }
    const double each_s = std::sqrt(2.0 * kDeg / a);
    EXPECT_NEAR(sum_s(machine, list, {}), (kBlocks + 1) * each_s, 0.03 * kBlocks * each_s);
    EXPECT_NEAR(sum_s(machine, list, {.stops = true}), kBlocks * 2.0 * std::sqrt(kDeg / a),
                0.02 * kBlocks * each_s);
}

// Long blocks run at the speed that they ask for.
TEST(BlendTime, OfSlowBlocksIsWhatTheyAskFor) {
    const Machine machine = test::machine_file("six_axis");
    BlockList list = test::empty_list(machine);
    test::add(list, {0, 0, 0, 0, 0, 0}, 0.0);
    for (int i = 1; i <= 50; ++i) {
        test::add(list, {i * 10'000, i * 1000, 0, 0, 0, 0}, 1.0);
    }
    EXPECT_NEAR(sum_s(machine, list, {.corner_mm = 2.0}), 50.0, 0.1);
}

}  // namespace
}  // namespace meshwind
