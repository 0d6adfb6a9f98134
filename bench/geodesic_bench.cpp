// The tracer and the freezing of a surface on irregular tori of real part sizes; bridges on a tee.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <Eigen/Geometry>

#include "bench/unfolding_kernel.h"
#include "core/units.h"
#include "geodesic/bridge.h"
#include "geodesic/trace.h"
#include "mesh/edge_table.h"
#include "mesh/segment/feature_edges.h"
#include "mesh/segment/rims.h"
#include "mesh/shapes/make_kinds.h"
#include "mesh/smooth/freeze.h"

namespace {

constexpr double kPath_mm = 600.0;

// So many that a pass outlasts what it evicts from the caches of the other, and that no branch
// predictor learns the ways by heart.
constexpr std::size_t kPaths = 512;

struct Parts {
    meshwind::TriangleSoup soup;
    std::vector<std::array<std::uint8_t, 3>> feature;
    std::vector<std::int32_t> region;
    meshwind::Rims rims;

    [[nodiscard]] meshwind::Surface freeze() const {
        return meshwind::freeze_surface(
            soup, {.feature = feature, .region = region, .rim = rims.of_edge});
    }
};

Parts parts_of(const char* kind, const meshwind::MakeValues& values, double edge_mm) {
    Parts parts;
    parts.soup = meshwind::make_mandrel(kind, values, {.edge_mm = edge_mm, .irregular = true});
    const auto neighbours = meshwind::face_neighbours(parts.soup.faces);
    parts.feature = meshwind::feature_edges(
        parts.soup, meshwind::steady_normals(parts.soup, neighbours), neighbours);
    parts.region.assign(parts.soup.faces.size(), 0);
    parts.rims = meshwind::find_rims(parts.soup);
    return parts;
}

// Frozen once per size: freezing a million triangles takes longer than any case.
const meshwind::Surface& torus(double edge_mm) {
    static std::map<double, meshwind::Surface> made;
    const auto known = made.find(edge_mm);
    return known != made.end()
               ? known->second
               : made.emplace(edge_mm, parts_of("torus", {}, edge_mm).freeze()).first->second;
}

struct Start {
    meshwind::SurfacePoint at;
    Eigen::Vector3d direction;
};

/// The centres of random faces with random directions, fixed seed.
std::vector<Start> random_starts(const meshwind::Surface& surface) {
    std::mt19937_64 random(1);
    std::uniform_int_distribution<std::int32_t> face(
        0, static_cast<std::int32_t>(surface.face.size()) - 1);
    std::uniform_real_distribution<double> turn(0.0, 2.0 * meshwind::kPi);
    std::vector<Start> starts;
    for (std::size_t i = 0; i < kPaths; ++i) {
        const meshwind::SurfacePoint at{.face = face(random)};
        const Eigen::Vector3d n = meshwind::smooth_normal(surface, at);
        const Eigen::Vector3d x = n.unitOrthogonal();
        const double angle = turn(random);
        starts.push_back({at, std::cos(angle) * x + std::sin(angle) * n.cross(x)});
    }
    return starts;
}

/// CPU seconds of one call of `work`, and the time of many calls: the median, as the machine may be
/// busy with something else.
template <class Work>
double seconds(const Work& work) {
    const std::clock_t begun = std::clock();
    work();
    return static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

struct Tracer {
    const char* name;
    meshwind::Steering steering;
    meshwind::TraceOptions options;
};

const std::array kTracers = {
    Tracer{"geodesic", {}, {.max_length_mm = kPath_mm}},
    Tracer{"steered", {0.1, 0.1}, {.max_length_mm = kPath_mm}},
    Tracer{"patches",
           {0.1, 0.1},
           {.max_length_mm = kPath_mm, .method = meshwind::TraceMethod::Patches}},
};

struct Size {
    const char* name;
    double edge_mm;
};

constexpr std::array kSizes = {Size{"10k", 9.5}, Size{"100k", 3.0}, Size{"1M_large", 0.96}};

/// 512 paths of 600 mm; items are edge crossings. The unfolding kernel takes turns with the tracer
/// on the same starts for as many crossings: `x_kernel` is the tracer's time divided by the
/// kernel's, medians of the same run.
void trace_torus(benchmark::State& state, double edge_mm, const Tracer& tracer) {
    const meshwind::Surface& surface = torus(edge_mm);
    const meshwind::bench::UnfoldingKernel kernel(surface);
    const std::vector<Start> starts = random_starts(surface);
    std::vector<std::size_t> crossings(starts.size());
    std::vector<double> tracer_s;
    std::vector<double> kernel_s;
    for (auto _ : state) {
        tracer_s.push_back(seconds([&] {
            for (std::size_t i = 0; i < kPaths; ++i) {
                const auto result = meshwind::trace(surface, starts[i].at, starts[i].direction,
                                                    tracer.steering, tracer.options);
                crossings[i] = result.path.size() - 2;  // without both ends
            }
        }));
        kernel_s.push_back(seconds([&] {
            for (std::size_t i = 0; i < kPaths; ++i) {
                benchmark::DoNotOptimize(
                    kernel.length_mm(surface, starts[i].at, starts[i].direction, crossings[i]));
            }
        }));
        state.SetIterationTime(tracer_s.back());
    }
    const auto all = std::accumulate(crossings.begin(), crossings.end(), 0.0);
    state.counters["triangles"] = static_cast<double>(surface.face.size());
    state.counters["ns"] = 1e9 * median(tracer_s) / all;
    state.counters["kernel_ns"] = 1e9 * median(kernel_s) / all;
    state.counters["x_kernel"] = median(tracer_s) / median(kernel_s);
}

const bool kRegistered = [] {
    for (const Size& size : kSizes) {
        for (const Tracer& tracer : kTracers) {
            const std::string name = std::string("trace_torus/") + tracer.name + "_" + size.name;
            benchmark::RegisterBenchmark(name.c_str(), trace_torus, size.edge_mm, tracer)
                ->Unit(benchmark::kMillisecond)
                ->UseManualTime();
        }
    }
    return true;
}();

/// Adjacency, corners and cubic fits; items are triangles.
void freeze_torus(benchmark::State& state, double edge_mm) {
    const Parts parts = parts_of("torus", {}, edge_mm);
    for (auto _ : state) {
        benchmark::DoNotOptimize(parts.freeze());
    }
    state.SetItemsProcessed(state.iterations() *
                            static_cast<std::int64_t>(parts.soup.faces.size()));
}
BENCHMARK_CAPTURE(freeze_torus, 10k, 9.5)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(freeze_torus, 100k, 3.0)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(freeze_torus, 1M_large, 0.96)->Unit(benchmark::kMillisecond)->UseRealTime();

/// From 512 places of a tee of 50 mm radius, scaled: where the straight fibre meets the wall again.
/// Walking along the wall alone takes turns with asking the lifted wall as well; `x_walked` is the
/// time of the second divided by that of the first, medians of the same run.
void look_ahead_on_tee(benchmark::State& state, double scale) {
    const meshwind::MakeValues values{{"run-radius", 50.0 * scale},
                                      {"branch-radius", 40.0 * scale},
                                      {"blend-radius", 15.0 * scale},
                                      {"run-length", 400.0 * scale},
                                      {"branch-length", 236.0 * scale}};
    const meshwind::Surface tee = parts_of("tee", values, 4.0 * scale).freeze();
    const meshwind::LiftedWall lifted(tee);
    const std::vector<Start> starts = random_starts(tee);
    const auto look = [&](const meshwind::LiftedWall* wall) {
        for (const Start& start : starts) {
            benchmark::DoNotOptimize(
                meshwind::bridge_ahead(tee, meshwind::FieldWalker(tee, start.at), start.direction,
                                       meshwind::bridge_reach_mm(tee), wall));
        }
    };
    std::vector<double> asked_s;
    std::vector<double> walked_s;
    for (auto _ : state) {
        asked_s.push_back(seconds([&] { look(&lifted); }));
        walked_s.push_back(seconds([&] { look(nullptr); }));
    }
    state.counters["x_walked"] = median(asked_s) / median(walked_s);
}
BENCHMARK_CAPTURE(look_ahead_on_tee, full, 1.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(look_ahead_on_tee, quarter, 0.25)->Unit(benchmark::kMillisecond);

}  // namespace
