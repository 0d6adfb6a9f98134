// From eye points to the program: dense points per second on a line around an ellipsoid and on a
// long helix; the time law alone by the number of steps; and all together with the text.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "core/parallel.h"
#include "machines/machine_json.h"
#include "postproc/motion/block.h"
#include "postproc/motion/choose_blocks.h"
#include "postproc/motion/time_law.h"
#include "postproc/nc/linuxcnc.h"
#include "tests/support/synthetic_paths.h"

namespace {

using namespace meshwind;

constexpr auto kPolicy = RedundancyPolicy::CentralAngle;

Machine six_axis() {
    return read_machine(MESHWIND_SOURCE_DIR "/machines/six_axis.json");
}

void choose(benchmark::State& state, const EyePath& path) {
    set_thread_count(1);
    const Machine machine = six_axis();
    const JointPath joints = solve_joints(machine, path, kPolicy);
    std::size_t blocks = 0;
    for (auto _ : state) {
        blocks = choose_blocks(machine, {.path = path, .joints = joints}, {}).ends.size();
        benchmark::DoNotOptimize(blocks);
    }
    state.counters["points/s"] = benchmark::Counter(static_cast<double>(path.size()),
                                                    benchmark::Counter::kIsIterationInvariantRate);
    state.counters["points/block"] = static_cast<double>(path.size()) / static_cast<double>(blocks);
}

// Blocks of some ten points, as on a tee.
void choose_on_ellipsoid(benchmark::State& state) {
    choose(state, test::on_ellipsoid({.swing = 0.5, .waves = 3.0}, 20'000));
}
BENCHMARK(choose_on_ellipsoid)->Unit(benchmark::kMillisecond);

// One block.
void choose_on_helix(benchmark::State& state) {
    choose(state, test::helix(70.0, std::numbers::pi / 4.0, 200.0, 2.0, 20'000));
}
BENCHMARK(choose_on_helix)->Unit(benchmark::kMillisecond);

void refine_ellipsoid(benchmark::State& state) {
    set_thread_count(1);
    const Machine machine = six_axis();
    const EyePath path = test::on_ellipsoid({.swing = 0.5, .waves = 3.0}, 2'000);
    for (auto _ : state) {
        benchmark::DoNotOptimize(refine_path(machine, path, kPolicy, {}).size());
    }
    state.counters["points/s"] = benchmark::Counter(static_cast<double>(path.size()),
                                                    benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(refine_ellipsoid)->Unit(benchmark::kMillisecond);

// Steps as short as points are, and by tens as in blocks. The controller's corners are left aside,
// or kept to 1 mm.
void time_steps(benchmark::State& state, double corner_mm) {
    const Machine machine = six_axis();
    const EyePath path =
        test::on_ellipsoid({.swing = 0.5, .waves = 3.0}, static_cast<int>(state.range(0)));
    EyePath turns;  // several, so that steps are some 10 mm whatever their number
    const std::size_t stride = std::max<std::size_t>(path.size() / 100, 1);
    for (std::size_t i = 0; i < path.size(); ++i) {
        turns.push_back(path[(i * stride) % path.size()]);
        turns.back().s_mm = 10.0 * static_cast<double>(i);
    }
    const JointPath joints = solve_joints(machine, turns, kPolicy);
    const std::vector<double> fibre_mm = fibre_moved_mm(turns);
    const TimeLawOptions options{.fibre_speed_mm_s = 500.0, .corner_mm = corner_mm};
    double duration_s = 0.0;
    for (auto _ : state) {
        duration_s = time_path(machine, fibre_mm, joints, options).duration_s;
        benchmark::DoNotOptimize(duration_s);
    }
    state.SetComplexityN(state.range(0));
    state.counters["steps/s"] = benchmark::Counter(static_cast<double>(path.size()),
                                                   benchmark::Counter::kIsIterationInvariantRate);
    state.counters["path_s"] = duration_s;
}
BENCHMARK_CAPTURE(time_steps, free, std::numeric_limits<double>::infinity())
    ->Arg(2'500)
    ->Arg(10'000)
    ->Arg(40'000)
    ->Complexity(benchmark::oN)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(time_steps, corners, 1.0)->Arg(10'000)->Unit(benchmark::kMillisecond);

// Axes, choice of blocks, time law, rounding and text; one thread.
void points_to_text(benchmark::State& state, const EyePath& path) {
    set_thread_count(1);
    const Machine machine = six_axis();
    const LinuxCnc dialect;
    std::size_t bytes = 0;
    for (auto _ : state) {
        const JointPath joints = solve_joints(machine, path, kPolicy);
        const BlockChoice choice = choose_blocks(machine, {.path = path, .joints = joints}, {});
        const TimedBlocks timed = make_blocks(machine, points_at(path, choice.ends),
                                              points_at(joints, choice.ends), choice.fibre_mm, {});
        bytes = dialect.write(machine, timed.list, {}).size();
        benchmark::DoNotOptimize(bytes);
    }
    state.counters["points/s"] = benchmark::Counter(static_cast<double>(path.size()),
                                                    benchmark::Counter::kIsIterationInvariantRate);
    state.counters["bytes"] = static_cast<double>(bytes);
}

void ellipsoid_to_text(benchmark::State& state) {
    points_to_text(state, test::on_ellipsoid({.swing = 0.5, .waves = 3.0}, 20'000));
}
BENCHMARK(ellipsoid_to_text)->Unit(benchmark::kMillisecond);

// 27 turns, so that blocks have some four points as on a tee.
void turns_to_text(benchmark::State& state) {
    const EyePath turn = test::on_ellipsoid({.swing = 0.5, .waves = 3.0}, 737);
    EyePath path;
    for (int i = 0; i < 27; ++i) {
        const double before_mm = path.empty() ? 0.0 : path.back().s_mm;
        for (std::size_t k = i == 0 ? 0 : 1; k < turn.size(); ++k) {
            path.push_back(turn[k]);
            path.back().s_mm += before_mm;
        }
    }
    points_to_text(state, path);
}
BENCHMARK(turns_to_text)->Unit(benchmark::kMillisecond);

void helix_to_text(benchmark::State& state) {
    points_to_text(state, test::helix(70.0, std::numbers::pi / 4.0, 200.0, 2.0, 20'000));
}
BENCHMARK(helix_to_text)->Unit(benchmark::kMillisecond);

}  // namespace
