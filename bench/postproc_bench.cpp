// Choice of blocks: dense points per second on a line around an ellipsoid and on a long helix.
#include <benchmark/benchmark.h>

#include <numbers>

#include "core/parallel.h"
#include "machines/machine_json.h"
#include "postproc/choose_blocks.h"
#include "tests/postproc/synthetic_paths.h"

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

}  // namespace
