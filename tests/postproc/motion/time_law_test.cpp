#include "postproc/motion/time_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "machines/machine_json.h"
#include "tests/support/synthetic_paths.h"

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
    EXPECT_LE(axis_loads(machine, result.joints, step_s).acceleration.ratio, 1.0 + 1e-8);
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
    // A step of 0.0505 rad has room for a ramp of sqrt(2 * 0.0505 / 31.4) s at most.
    EXPECT_LT(result.time.ramp_s, 0.057);
    // All but the start and the stop is one stretch.
    ASSERT_FALSE(result.time.binding[0].stretches.empty());
    const BindingStretch& longest = result.time.binding[0].stretches[0];
    EXPECT_GT(longest.time_s, 19.5);
    EXPECT_LT(longest.first, 60U);
    EXPECT_GT(longest.last, 1940U);
}

TEST(TimeLaw, AccelerationsHoldThroughTurns) {
    const Machine machine = six_axis();
    const Timed result =
        timed(machine, test::strokes(70.0, 200.0, 2.0, 400.0, 4), {.fibre_speed_mm_s = 1000.0});
    expect_limits_kept(machine, result, 1000.0);
    // The same path at the speed of fibre and axes alone: the turns are too fast.
    Machine strong = machine;
    for (std::vector<Axis>* const chain : {&strong.mandrel_chain, &strong.eye_chain}) {
        for (Axis& axis : *chain) {
            axis.acceleration *= 1e6;
        }
    }
    const Timed loose = timed(strong, result.path, {.fibre_speed_mm_s = 1000.0});
    EXPECT_GT(axis_loads(machine, loose.joints, loose.time.step_s).acceleration.ratio, 1.5);
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
    expect_limits_kept(machine, result, 1000.0);
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

// A path of the axes Z, Y and X of six_axis, the others at rest.
JointPath moves(const Machine& machine, const std::vector<std::array<double, 3>>& steps_mm) {
    JointPath path{.axis_count = machine.axis_count(), .joints = {}, .violations = {}, .notes = {}};
    std::vector<double> row(path.axis_count, 0.0);
    path.joints = row;
    for (const auto& step_mm : steps_mm) {
        for (std::size_t a = 0; a < step_mm.size(); ++a) {
            row[1 + a] += step_mm[a];
        }
        path.joints.insert(path.joints.end(), row.begin(), row.end());
    }
    return path;
}

std::vector<double> no_fibre(const JointPath& path) {
    return std::vector<double>(path.size(), 0.0);
}

std::vector<std::array<double, 3>> random_steps(unsigned seed, int n) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> turn(-0.6, 0.6);
    std::uniform_real_distribution<double> length(-1.0, 1.0);
    std::vector<std::array<double, 3>> steps;
    double heading = 0.0;
    for (int i = 0; i < n; ++i) {
        heading += turn(random);
        const double mm = 10.0 * std::exp(length(random));
        steps.push_back({mm * std::cos(heading), mm * std::sin(heading), mm * turn(random)});
    }
    return steps;
}

// What the ramps ask of durations, written again from the words of axis_loads.h and time_law.h for
// linear axes without jerk: half of both ramps within a step, corners cut by v a time/8.
bool runs(const Machine& machine, const std::vector<std::array<double, 3>>& steps,
          const std::vector<double>& time_s, std::size_t step, double corner_mm) {
    double cut_mm2 = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
        const double limit = machine.axis(1 + a).acceleration;
        const auto v = [&](std::size_t i) {
            return i == 0 || i > steps.size() ? 0.0 : steps[i - 1][a] / time_s[i];
        };
        const double in = std::abs(v(step) - v(step - 1));
        const double out = std::abs(v(step + 1) - v(step));
        if (in / limit + out / limit > 2.0 * time_s[step] * (1.0 + 1e-9)) {
            return false;
        }
        if (step < steps.size()) {
            cut_mm2 += std::pow(out * out / limit / 8.0, 2);
        }
    }
    return std::sqrt(cut_mm2) <= corner_mm * (1.0 + 1e-9);
}

// Least time out of a grid of durations, all tried: by dynamic programming over pairs.
double least_on_grid(const Machine& machine, const std::vector<std::array<double, 3>>& steps,
                     double corner_mm, int levels, double ratio) {
    const std::size_t n = steps.size();
    std::vector<double> least_s(n + 2, 1.0);
    for (std::size_t i = 1; i <= n; ++i) {
        least_s[i] = 0.0;
        for (std::size_t a = 0; a < 3; ++a) {
            least_s[i] =
                std::max(least_s[i], std::abs(steps[i - 1][a]) / machine.axis(1 + a).velocity);
        }
    }
    const auto grid = [&](std::size_t i, int k) {
        return i == 0 || i > n ? 1.0 : least_s[i] * std::pow(ratio, k);
    };
    const auto count = [&](std::size_t i) { return i == 0 || i > n ? 1 : levels; };
    const double none = std::numeric_limits<double>::infinity();
    const auto side = static_cast<std::size_t>(levels);
    std::vector<double> cost(side * side, none);
    for (int j = 0; j < levels; ++j) {
        cost[static_cast<std::size_t>(j)] = 0.0;
    }
    std::vector<double> time_s(n + 2, 0.0);
    for (std::size_t i = 1; i <= n; ++i) {
        std::vector<double> now(side * side, none);
        for (int h = 0; h < count(i - 1); ++h) {
            for (int j = 0; j < count(i); ++j) {
                const double before =
                    cost[static_cast<std::size_t>(h) * side + static_cast<std::size_t>(j)];
                for (int k = 0; before < none && k < count(i + 1); ++k) {
                    time_s[i - 1] = grid(i - 1, h);
                    time_s[i] = grid(i, j);
                    time_s[i + 1] = grid(i + 1, k);
                    double& to =
                        now[static_cast<std::size_t>(j) * side + static_cast<std::size_t>(k)];
                    if (before + time_s[i] < to && runs(machine, steps, time_s, i, corner_mm)) {
                        to = before + time_s[i];
                    }
                }
            }
        }
        cost = std::move(now);
    }
    return *std::min_element(cost.begin(), cost.end());
}

TEST(TimeLaw, IsAsFastAsTheBestOnAFineGrid) {
    const Machine machine = six_axis();
    constexpr double kRatio = 1.03;
    double law_s = 0.0;
    double grid_s = 0.0;
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const auto steps = random_steps(seed, 12);
        for (const double corner_mm : {std::numeric_limits<double>::infinity(), 1.0}) {
            SCOPED_TRACE(::testing::Message() << "seed " << seed << " corner " << corner_mm);
            const JointPath path = moves(machine, steps);
            const TimedPath time = time_path(machine, no_fibre(path), path,
                                             {.fibre_speed_mm_s = 500.0, .corner_mm = corner_mm});
            std::vector<double> padded = time.step_s;
            padded.push_back(1.0);
            for (std::size_t i = 1; i <= steps.size(); ++i) {
                EXPECT_TRUE(runs(machine, steps, padded, i, corner_mm));
            }
            const double least_s = least_on_grid(machine, steps, corner_mm, 80, kRatio);
            const double sum_s = time.duration_s - time.ramp_s;
            // The grid's steps are 3 %, so the best may be as much shorter; what the law may lose
            // in a single short path is more than what it loses in the mean.
            EXPECT_LT(sum_s, 1.03 * least_s);
            EXPECT_GT(sum_s, least_s / kRatio);
            law_s += sum_s;
            grid_s += least_s;
        }
    }
    EXPECT_LT(law_s, 1.01 * grid_s);
}

TEST(TimeLaw, StraightLineTakesTheTimeOfBangBang) {
    // d = 300 mm of Z from rest to rest at 3000 mm/s^2: 2 sqrt(d/a), never at 1000 mm/s. Nothing
    // that keeps the acceleration can be faster, in however many steps.
    const Machine machine = six_axis();
    const double exact_s = 2.0 * std::sqrt(300.0 / 3000.0);
    for (const int n : {2, 10, 30, 120, 480, 2000}) {
        const JointPath path = moves(
            machine,
            std::vector<std::array<double, 3>>(static_cast<std::size_t>(n), {300.0 / n, 0.0, 0.0}));
        const double duration_s = time_path(machine, no_fibre(path), path).duration_s;
        EXPECT_GE(duration_s, exact_s * (1.0 - 1e-9)) << n;
        EXPECT_LE(duration_s, exact_s * 1.01) << n;
    }
}

TEST(TimeLaw, CircleRunsAtItsCentripetalAcceleration) {
    // Radius 100 mm in the plane of Y and X, both 2500 mm/s^2: v = sqrt(a r) = 500 mm/s all the
    // time, which is also their velocity. Half of that acceleration: 353.6 mm/s.
    Machine machine = six_axis();
    constexpr double kRadius_mm = 100.0;
    constexpr int kPerTurn = 200;
    constexpr int kTurns = 10;
    for (Axis& axis : machine.eye_chain) {
        axis.acceleration = axis.type == AxisType::Linear ? 1250.0 : axis.acceleration;
    }
    std::vector<std::array<double, 3>> steps;
    const double angle = 2.0 * std::numbers::pi / kPerTurn;
    for (int i = 0; i < kTurns * kPerTurn; ++i) {
        steps.push_back({0.0, kRadius_mm * (std::cos((i + 1) * angle) - std::cos(i * angle)),
                         kRadius_mm * (std::sin((i + 1) * angle) - std::sin(i * angle))});
    }
    const JointPath path = moves(machine, steps);
    const TimedPath time = time_path(machine, no_fibre(path), path);
    double turn_s = 0.0;  // one in the middle
    for (int i = 5 * kPerTurn; i < 6 * kPerTurn; ++i) {
        turn_s += time.step_s[static_cast<std::size_t>(i)];
    }
    // Between the directions of the axes both together may do more than one: up to sqrt 2 on the
    // diagonal, for x = -v^2/r cos holds |x| to 1250 only where the tangential part is 0. So a turn
    // at constant speed is the slowest that the limits call for, and it may be somewhat faster.
    const double even_s = 2.0 * std::numbers::pi * std::sqrt(kRadius_mm / 1250.0);
    EXPECT_LT(turn_s, 1.005 * even_s);
    EXPECT_GT(turn_s, 0.9 * even_s);
}

// Follows one axis through ramps about the corners and returns the farthest that it gets from the
// program, at even samples of `sample_s`, and the largest change of its velocity a second.
struct Ride {
    double off = 0.0;
    double off_at_end = 0.0;
    double acceleration = 0.0;
};

Ride ride(const Axis& axis, const std::vector<double>& moves_mm, const std::vector<double>& time_s,
          double sample_s) {
    std::vector<double> end_s{0.0};
    std::vector<double> end_mm{0.0};
    std::vector<double> speed{0.0};
    for (std::size_t i = 0; i < moves_mm.size(); ++i) {
        end_s.push_back(end_s.back() + time_s[i]);
        end_mm.push_back(end_mm.back() + moves_mm[i]);
        speed.push_back(moves_mm[i] / time_s[i]);
    }
    speed.push_back(0.0);
    // Of all ramps together, in the mean from one time to another.
    const auto acceleration_in = [&](double from_s, double to_s) {
        double sum = 0.0;
        for (std::size_t i = 0; i < end_s.size(); ++i) {
            const double change = speed[i + 1] - speed[i];
            const double half_s = 0.5 * std::abs(change) / axis.acceleration;
            const double within_s =
                std::min(to_s, end_s[i] + half_s) - std::max(from_s, end_s[i] - half_s);
            sum += within_s > 0.0 ? std::copysign(axis.acceleration, change) * within_s : 0.0;
        }
        return sum / (to_s - from_s);
    };
    Ride ride;
    double v = 0.0;
    double x = 0.0;
    std::size_t step = 0;
    for (double t = -1.0; t < end_s.back() + 1.0; t += sample_s) {
        const double a = acceleration_in(t, t + sample_s);
        x += (v + 0.5 * a * sample_s) * sample_s;
        v += a * sample_s;
        const double now_s = t + sample_s;
        while (step + 1 < end_s.size() && end_s[step + 1] < now_s) {
            ++step;
        }
        const double there_mm = now_s < 0.0 ? 0.0
                                : step + 1 == end_s.size()
                                    ? end_mm.back()
                                    : end_mm[step] + speed[step + 1] * (now_s - end_s[step]);
        ride.off = std::max(ride.off, std::abs(x - there_mm));
        ride.off_at_end = std::abs(x - there_mm);
        ride.acceleration = std::max(ride.acceleration, std::abs(a));
    }
    return ride;
}

TEST(TimeLaw, AnAxisThatRampsAboutTheCornersRunsTheProgram) {
    const Machine machine = six_axis();
    const auto steps = random_steps(11, 60);
    const JointPath path = moves(machine, steps);
    const TimedPath time = time_path(machine, no_fibre(path), path);
    const AxisLoads loads = axis_loads(machine, path, time.step_s);
    EXPECT_GT(loads.acceleration.ratio, 0.99);
    const std::vector<double> time_s(time.step_s.begin() + 1, time.step_s.end());
    for (std::size_t a = 0; a < 3; ++a) {
        std::vector<double> moves_mm;
        for (const auto& step : steps) {
            moves_mm.push_back(step[a]);
        }
        const Axis& axis = machine.axis(1 + a);
        const Ride result = ride(axis, moves_mm, time_s, 2e-5);
        // Ramps that overlapped would add up to more.
        EXPECT_LT(result.acceleration, axis.acceleration * 1.0001);
        // At the corners as far off as the loads say, and nothing adds up. The start and the stop
        // are no corners: they begin and end on the path.
        const double rest_mm = std::max(std::pow(moves_mm.front() / time_s.front(), 2),
                                        std::pow(moves_mm.back() / time_s.back(), 2)) /
                               axis.acceleration / 8.0;
        EXPECT_LT(result.off, std::max(loads.linear.mm, rest_mm) + 0.02);
        EXPECT_LT(result.off_at_end, 0.02);
    }
}

TEST(TimeLaw, CornersAreCutNoFartherThanTold) {
    const Machine machine = six_axis();
    const JointPath path = moves(machine, random_steps(5, 200));
    double before_s = 0.0;
    for (const double corner_mm : {5.0, 1.0, 0.2, 0.02}) {
        const TimedPath time = time_path(machine, no_fibre(path), path,
                                         {.fibre_speed_mm_s = 500.0, .corner_mm = corner_mm});
        const CornerCut cut = axis_loads(machine, path, time.step_s).linear;
        EXPECT_LE(cut.mm, corner_mm * (1.0 + 1e-6));
        EXPECT_GT(cut.mm, corner_mm < 5.0 ? 0.99 * corner_mm : 0.0);
        EXPECT_GT(time.duration_s, before_s);
        before_s = time.duration_s;
        EXPECT_EQ(time.binding[0].name == "corner", corner_mm < 5.0);
    }
}

TEST(AxisLoads, RampsWithJerkTakeTheClosedForm) {
    Axis axis;
    axis.acceleration = 3000.0;
    axis.jerk = std::numeric_limits<double>::infinity();
    EXPECT_DOUBLE_EQ(ramp_s(axis, -600.0), 0.2);
    // a/j = 0.1 s: 600 mm/s take 0.2 + 0.1 s. 75 mm/s never reach the acceleration: 2 sqrt(75/j);
    // both forms meet at a^2/j = 300 mm/s.
    axis.jerk = 30000.0;
    EXPECT_DOUBLE_EQ(ramp_s(axis, 600.0), 0.3);
    EXPECT_DOUBLE_EQ(ramp_s(axis, 75.0), 0.1);
    EXPECT_DOUBLE_EQ(ramp_s(axis, 300.0), 0.2);
    EXPECT_NEAR(ramp_s(axis, 300.0 - 1e-9), 0.2, 1e-9);
    // The integral of the acceleration's trapezoid or triangle is the change of velocity.
    for (const double change : {10.0, 75.0, 300.0, 450.0, 900.0}) {
        const double time_s = ramp_s(axis, change);
        double sum = 0.0;
        constexpr int kSamples = 100'000;
        for (int i = 0; i < kSamples; ++i) {
            const double t = (i + 0.5) * time_s / kSamples;
            sum += std::min({axis.jerk * t, axis.jerk * (time_s - t), axis.acceleration}) * time_s /
                   kSamples;
        }
        EXPECT_NEAR(sum, change, 1e-6 * change);
    }
}

TEST(AxisLoads, MeasuresOneCornerByHand) {
    // Z at 100 mm/s for 0.5 s, then at 400 mm/s for 0.25 s, at 3000 mm/s^2: ramps of 1/30 s, 0.1 s
    // and 2/15 s. The second step has 0.05 + 1/15 of its 0.25 s in use. 300 * 0.1 / 8 = 3.75 mm.
    const Machine machine = six_axis();
    const JointPath path = moves(machine, {{50.0, 0.0, 0.0}, {100.0, 0.0, 0.0}});
    const AxisLoads loads = axis_loads(machine, path, std::vector<double>{0.0, 0.5, 0.25});
    EXPECT_NEAR(loads.acceleration.ratio, (0.05 + 1.0 / 15.0) / 0.25, 1e-12);
    EXPECT_EQ(loads.acceleration.step, 2U);
    EXPECT_EQ(loads.acceleration.joint, 1U);
    EXPECT_NEAR(loads.velocity.ratio, 0.4, 1e-12);
    EXPECT_NEAR(loads.linear.mm, 3.75, 1e-12);
    EXPECT_EQ(loads.linear.step, 1U);
    EXPECT_NEAR(loads.eye.mm, 3.75, 1e-12);
}

TEST(TimeLaw, JerkTakesTimeAndIsNamed) {
    Machine machine = six_axis();
    const JointPath path = moves(machine, random_steps(3, 100));
    const double free_s = time_path(machine, no_fibre(path), path).duration_s;
    double before_s = free_s;
    for (const double jerk : {1e9, 1e5, 1e4}) {
        for (Axis& axis : machine.eye_chain) {
            axis.jerk = jerk;
        }
        const TimedPath time = time_path(machine, no_fibre(path), path);
        EXPECT_LE(axis_loads(machine, path, time.step_s).acceleration.ratio, 1.0 + 1e-8);
        EXPECT_GT(time.duration_s, jerk > 1e8 ? 0.999 * free_s : 1.05 * before_s);
        EXPECT_LT(time.duration_s, jerk > 1e8 ? 1.001 * free_s : 20.0 * free_s);
        before_s = time.duration_s;
    }
    const TimedPath slow = time_path(machine, no_fibre(path), path);
    EXPECT_NE(slow.binding[0].name.find(" jerk"), std::string::npos);
}

TEST(TimeLaw, LongestStretchesAddUpAndComeFirst) {
    const Machine machine = six_axis();
    const JointPath path = moves(machine, random_steps(8, 300));
    const TimedPath time = time_path(machine, no_fibre(path), path);
    double all_s = time.ramp_s;
    for (const BindingLimit& limit : time.binding) {
        all_s += limit.time_s;
        ASSERT_FALSE(limit.stretches.empty());
        ASSERT_LE(limit.stretches.size(), 3U);
        for (std::size_t i = 0; i < limit.stretches.size(); ++i) {
            const BindingStretch& stretch = limit.stretches[i];
            const auto first = time.step_s.begin() + static_cast<std::ptrdiff_t>(stretch.first);
            const auto last = time.step_s.begin() + static_cast<std::ptrdiff_t>(stretch.last) + 1;
            EXPECT_NEAR(stretch.time_s, std::accumulate(first, last, 0.0), 1e-12);
            EXPECT_LE(stretch.time_s, limit.stretches[0].time_s);
        }
    }
    EXPECT_NEAR(all_s, time.duration_s, 1e-9);
}

TEST(TimeLaw, RestTakesNoTime) {
    const Machine machine = six_axis();
    EyePath path = test::helix(70.0, rad_from_deg(45.0), 200.0, 5.0, 1);
    path.push_back(path.back());
    const Timed result = timed(machine, path, {});
    EXPECT_EQ(result.time.duration_s, 0.0);
    EXPECT_EQ(axis_loads(machine, result.joints, result.time.step_s).acceleration.ratio, 0.0);
    EXPECT_TRUE(result.time.binding.empty());
}

TEST(TimeLaw, WholeTicksKeepTheLimitsToo) {
    const Machine machine = six_axis();
    const EyePath path = test::strokes(70.0, 200.0, 2.0, 400.0, 4);
    const Timed any = timed(machine, path, {});
    for (const double tick_s : {0.001, 0.01}) {
        const Timed result = timed(machine, path, {.tick_s = tick_s});
        expect_limits_kept(machine, result, 500.0);
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
