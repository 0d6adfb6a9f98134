#include "postproc/time_law.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "machines/machine_json.h"
#include "tests/postproc/synthetic_paths.h"

namespace meshwind {
namespace {

Machine six_axis() {
    return read_machine(std::string(MESHWIND_SOURCE_DIR) + "/machines/six_axis.json");
}

struct Timed {
    EyePath path;
    JointPath joints;
    TimedPath time;
};

Timed timed(const Machine& machine, EyePath path, const TimeLawOptions& options) {
    Timed result{.path = std::move(path), .joints = {}, .time = {}};
    result.joints = solve_joints(machine, result.path, RedundancyPolicy::CentralAngle);
    result.time = time_path(machine, fibre_moved_mm(result.path), result.joints, options);
    return result;
}

void expect_limits_kept(const Machine& machine, const Timed& result, double fibre_mm_s) {
    const auto& step_s = result.time.step_s;
    ASSERT_EQ(step_s.size(), result.path.size());
    EXPECT_EQ(step_s[0], 0.0);
    for (std::size_t i = 1; i < step_s.size(); ++i) {
        ASSERT_GT(step_s[i], 0.0);
        for (std::size_t a = 0; a < machine.axis_count(); ++a) {
            const double move = std::abs(result.joints.row(i)[a] - result.joints.row(i - 1)[a]);
            ASSERT_LE(move, machine.axis(a).velocity * step_s[i] * (1.0 + 1e-12));
        }
        const double laid = result.path[i].s_mm - result.path[i - 1].s_mm;
        ASSERT_LE(laid, fibre_mm_s * step_s[i] * (1.0 + 1e-12));
    }
    EXPECT_NEAR(std::accumulate(step_s.begin(), step_s.end(), result.time.ramp_s),
                result.time.duration_s, 1e-9 * result.time.duration_s);
}

TEST(TimeLaw, LongHelixRunsAtTheFibreSpeed) {
    const Machine machine = six_axis();
    const Timed result =
        timed(machine, test::helix(70.0, rad_from_deg(45.0), 200.0, 5.0, 2000), {});
    expect_limits_kept(machine, result, 500.0);
    ASSERT_FALSE(result.time.binding.empty());
    EXPECT_EQ(result.time.binding[0].name, "fibre");
    // 9995 mm at 500 mm/s, and starting and stopping: 5.05 rad/s of C at 31.4 rad/s^2 are 0.16 s,
    // 354 mm/s of Z at 3000 mm/s^2 are 0.12 s; the longer one costs half of itself at both ends,
    // and the first and last step a ramp of their own.
    EXPECT_GT(result.time.duration_s, 19.99 + 0.16);
    EXPECT_LT(result.time.duration_s, 19.99 + 0.17 + result.time.ramp_s);
    EXPECT_LT(result.time.ramp_s, 0.03);
    EXPECT_LE(result.time.worst_acceleration_ratio, 1.0 + 1e-5);
}

TEST(TimeLaw, AccelerationsHoldThroughTurns) {
    const Machine machine = six_axis();
    const Timed result =
        timed(machine, test::strokes(70.0, 200.0, 2.0, 400.0, 4), {.fibre_speed_mm_s = 1000.0});
    expect_limits_kept(machine, result, 1000.0);
    EXPECT_LE(result.time.worst_acceleration_ratio, 1.0 + 1e-5);
    const Timed loose =
        timed(machine, result.path, {.fibre_speed_mm_s = 1000.0, .acceleration_sweeps = 0});
    EXPECT_GT(loose.time.worst_acceleration_ratio, 1.0);
    EXPECT_LT(loose.time.duration_s, result.time.duration_s);
}

TEST(TimeLaw, SlowAxisBindsAndIsNamed) {
    Machine machine = six_axis();
    machine.eye_chain[0].velocity = 10.0;  // Z
    const Timed result = timed(machine, test::helix(70.0, rad_from_deg(45.0), 200.0, 5.0, 200), {});
    expect_limits_kept(machine, result, 500.0);
    EXPECT_EQ(result.time.binding[0].name, "Z velocity");
    EXPECT_NEAR(result.time.duration_s, 199 * 3.535533906 / 10.0, 0.2);
}

TEST(TimeLaw, MachineSpeedHoldsAboveTheJob) {
    Machine machine = six_axis();
    machine.fibre.max_speed_mm_s = 50.0;
    const Timed result = timed(machine, test::helix(70.0, rad_from_deg(45.0), 200.0, 5.0, 200), {});
    expect_limits_kept(machine, result, 50.0);
}

TEST(TimeLaw, ReversalStopsWithinTheAcceleration) {
    // One axis forth and back in a single corner: v -> -v is the worst corner there is.
    const Machine machine = six_axis();
    EyePath path;
    for (int i = 0; i <= 200; ++i) {
        EyePoint point;
        const double z = i <= 100 ? i : 200.0 - i;
        point.s_mm = i;
        point.landing_mm = {70.0, 0.0, z};
        point.tangent = {0.0, 1.0, 0.0};
        point.binormal = {0.0, 0.0, 1.0};
        point.eye_mm = {300.0, 0.0, z};
        path.push_back(point);
    }
    const Timed result = timed(machine, path, {.fibre_speed_mm_s = 1000.0});
    EXPECT_LE(result.time.worst_acceleration_ratio, 1.0 + 1e-5);
    // Two strokes of 100 mm from rest to rest at 3000 mm/s^2 need 2 * 2 sqrt(100/3000) = 0.730 s.
    EXPECT_NEAR(result.time.duration_s, 0.730, 0.05);
}

TEST(TimeLaw, LongStepFromRestToRestIncludesItsRamps) {
    const Machine machine = six_axis();
    const EyePath dense = test::helix(70.0, rad_from_deg(45.0), 200.0, 5.0, 2001);
    const JointPath joints = solve_joints(machine, dense, RedundancyPolicy::CentralAngle);
    JointPath one{.axis_count = joints.axis_count, .joints = {}, .violations = {}, .notes = {}};
    for (const std::size_t i : {0U, 2000U}) {
        one.joints.insert(one.joints.end(), joints.row(i).begin(), joints.row(i).end());
    }
    const TimedPath time = time_path(machine, std::vector<double>{0.0, 10000.0}, one);
    EXPECT_NEAR(time.step_s[1], 20.0, 1e-12);
    // C reaches 500 / (70 sqrt 2) rad/s at 1800 deg/s^2: half of that time at the start, half at
    // the stop.
    const double ramp_s = 500.0 / (70.0 * std::sqrt(2.0)) / rad_from_deg(1800.0);
    EXPECT_NEAR(time.ramp_s, ramp_s, 1e-9);
    EXPECT_NEAR(time.duration_s, 20.0 + ramp_s, 1e-9);
}

TEST(TimeLaw, RampsStayWithinTheShorterStep) {
    // A long slow step beside short fast ones: the long one lends no more than the short one lasts.
    const Machine machine = six_axis();
    const std::size_t axes = machine.axis_count();
    JointPath path{.axis_count = axes, .joints = {}, .violations = {}, .notes = {}};
    double z_mm = 0.0;
    std::vector<double> fibre_mm;
    for (int i = 0; i < 60; ++i) {
        z_mm += i == 0 ? 0.0 : i == 30 ? 10.0 : 5.0;
        fibre_mm.push_back(i == 30 ? 200.0 : 1.0);  // step 30 is held up by the fibre
        std::vector<double> row(axes, 0.0);
        row[1] = z_mm;
        path.joints.insert(path.joints.end(), row.begin(), row.end());
    }
    const TimedPath time = time_path(machine, fibre_mm, path, {.fibre_speed_mm_s = 500.0});
    EXPECT_NEAR(time.step_s[30], 0.4, 1e-12);
    EXPECT_LE(time.worst_acceleration_ratio, 1.0 + 1e-5);
    const double change = 5.0 / time.step_s[31] - 10.0 / time.step_s[30];
    EXPECT_NEAR(change, 1.5 * 3000.0 * time.step_s[31], 1e-3 * change);
    EXPECT_NEAR(time.step_s[29], time.step_s[31], 1e-3 * time.step_s[31]);
}

TEST(TimeLaw, RestTakesNoTime) {
    const Machine machine = six_axis();
    EyePath path = test::helix(70.0, rad_from_deg(45.0), 200.0, 5.0, 1);
    path.push_back(path.back());
    const Timed result = timed(machine, path, {});
    EXPECT_EQ(result.time.duration_s, 0.0);
    EXPECT_EQ(result.time.worst_acceleration_ratio, 0.0);
    EXPECT_TRUE(result.time.binding.empty());
}

TEST(TimeLaw, WholeTicksKeepTheLimitsToo) {
    const Machine machine = six_axis();
    const EyePath path = test::strokes(70.0, 200.0, 2.0, 400.0, 4);
    const Timed any = timed(machine, path, {});
    for (const double tick_s : {0.001, 0.01}) {
        const Timed result = timed(machine, path, {.tick_s = tick_s});
        expect_limits_kept(machine, result, 500.0);
        EXPECT_LE(result.time.worst_acceleration_ratio, 1.0 + 1e-5);
        for (const double step_s : result.time.step_s) {
            EXPECT_NEAR(step_s / tick_s, std::round(step_s / tick_s), 1e-9);
        }
        EXPECT_GT(result.time.duration_s, any.time.duration_s);
    }
}

TEST(TimeLaw, RefusesAFibreSpeedOfZero) {
    EXPECT_THROW((void)timed(six_axis(), {}, {.fibre_speed_mm_s = 0.0}), InputError);
}

}  // namespace
}  // namespace meshwind
