// Winding a program again: blocks per second, and its time as a multiple of tracing as much fibre
// in the same run.
#include <chrono>

#include <benchmark/benchmark.h>

#include "geodesic/trace.h"
#include "machines/machine_json.h"
#include "mesh/shapes/make.h"
#include "postproc/motion/choose_blocks.h"
#include "postproc/verify/laydown.h"
#include "tests/support/frozen.h"
#include "tests/support/synthetic_paths.h"

namespace {

using namespace meshwind;

// What synthetic_paths.h winds around.
constexpr double kHalfY_mm = 60.0;
constexpr EllipsoidShape kSpheroid{.equator_radius_mm = 90.0, .pole_radius_mm = 150.0};
constexpr test::EllipsoidLine kLine{.swing = 0.5, .waves = 3.0};

Surface ellipsoid(double edge_mm) {
    TriangleSoup soup = make_ellipsoid(kSpheroid, {.edge_mm = edge_mm, .irregular = true});
    for (Eigen::Vector3d& point : soup.points_mm) {
        point.y() *= kHalfY_mm / kSpheroid.equator_radius_mm;
    }
    return test::frozen(soup);
}

double seconds(std::chrono::steady_clock::duration duration) {
    return std::chrono::duration<double>(duration).count();
}

void lay_on_ellipsoid(benchmark::State& state) {
    const Machine machine = read_machine(MESHWIND_SOURCE_DIR "/machines/six_axis.json");
    const LaydownSurface wall(ellipsoid(static_cast<double>(state.range(0))));
    const Surface& surface = wall.surface();
    const EyePath path = test::on_ellipsoid(kLine, 4'000);
    const JointPath joints = solve_joints(machine, path, RedundancyPolicy::CentralAngle);
    const BlockChoice choice = choose_blocks(machine, {.path = path, .joints = joints}, {});
    const BlockList list = make_blocks(machine, points_at(path, choice.ends),
                                       points_at(joints, choice.ends), choice.fibre_mm)
                               .list;
    const Eigen::Vector3d start = path.front().landing_mm;
    double laying_s = 0.0;
    double tracing_s = 0.0;
    for (auto _ : state) {
        const auto begun = std::chrono::steady_clock::now();
        const LaidPath laid = lay_down(wall, machine, list, start);
        const auto halfway = std::chrono::steady_clock::now();
        if (!laid.failure.empty()) {
            state.SkipWithError(laid.failure.c_str());
            break;
        }
        benchmark::DoNotOptimize(
            trace(surface, laid.path.front().at, path.front().tangent, {},
                  {.max_length_mm = laid.path.back().s_mm, .method = TraceMethod::Patches}));
        laying_s += seconds(halfway - begun);
        tracing_s += seconds(std::chrono::steady_clock::now() - halfway);
        state.SetIterationTime(seconds(halfway - begun));
    }
    state.counters["blocks/s"] = benchmark::Counter(static_cast<double>(list.blocks.size()),
                                                    benchmark::Counter::kIsIterationInvariantRate);
    state.counters["traces"] = laying_s / tracing_s;
}
BENCHMARK(lay_on_ellipsoid)->Arg(10)->Arg(5)->Unit(benchmark::kMillisecond)->UseManualTime();

}  // namespace
