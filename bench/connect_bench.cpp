// Paths between two points on irregular tori: the tree of exact shortest ways, and the shooting
// from them.
#include <chrono>
#include <cstdint>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "geodesic/connect.h"
#include "mesh/edge_table.h"
#include "mesh/segment/feature_edges.h"
#include "mesh/segment/rims.h"
#include "mesh/shapes/make_kinds.h"
#include "mesh/smooth/freeze.h"

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kTargets = 32;

meshwind::Surface torus(double edge_mm) {
    const meshwind::TriangleSoup soup =
        meshwind::make_mandrel("torus", {}, {.edge_mm = edge_mm, .irregular = true});
    const auto neighbours = meshwind::face_neighbours(soup.faces);
    const auto feature =
        meshwind::feature_edges(soup, meshwind::steady_normals(soup, neighbours), neighbours);
    const std::vector<std::int32_t> region(soup.faces.size(), 0);
    const meshwind::Rims rims = meshwind::find_rims(soup);
    return meshwind::freeze_surface(soup,
                                    {.feature = feature, .region = region, .rim = rims.of_edge});
}

double seconds_since(Clock::time_point begun) {
    return std::chrono::duration<double>(Clock::now() - begun).count();
}

/// From one source to 32 random targets, fixed seed: an iteration builds the tree, asks it for all
/// ways and shoots from each. `tree_s` for the tree, `way_ms` and `shot_ms` for one target;
/// `tree_per_shot` is their ratio. \param slip_ratio 0: geodesics
void connect_torus(benchmark::State& state, double edge_mm, double slip_ratio) {
    const meshwind::Surface surface = torus(edge_mm);
    std::mt19937_64 random(1);
    std::uniform_int_distribution<std::int32_t> face(
        0, static_cast<std::int32_t>(surface.face.size()) - 1);
    meshwind::SurfacePoint from;
    from.face = face(random);
    std::vector<meshwind::SurfacePoint> targets(kTargets);
    for (meshwind::SurfacePoint& target : targets) {
        target.face = face(random);
    }
    double tree_s = 0.0;
    double ways_s = 0.0;
    double shots_s = 0.0;
    double reached = 0.0;
    double iterations = 0.0;
    for (auto _ : state) {
        Clock::time_point begun = Clock::now();
        meshwind::ShortestPaths tree(surface, from);
        tree_s += seconds_since(begun);
        begun = Clock::now();
        std::vector<meshwind::PolyhedralPath> ways;
        for (const meshwind::SurfacePoint& target : targets) {
            ways.push_back(tree.to(target).value());
        }
        ways_s += seconds_since(begun);
        begun = Clock::now();
        for (std::size_t i = 0; i < kTargets; ++i) {
            const auto result = meshwind::connect(surface, from, targets[i], ways[i], slip_ratio);
            reached += result.stop == meshwind::ConnectStop::Reached ? 1.0 : 0.0;
            iterations += result.iterations;
        }
        shots_s += seconds_since(begun);
    }
    const auto runs = static_cast<double>(state.iterations());
    const double shots = runs * kTargets;
    state.counters["triangles"] = static_cast<double>(surface.face.size());
    state.counters["tree_s"] = tree_s / runs;
    state.counters["way_ms"] = 1e3 * ways_s / shots;
    state.counters["shot_ms"] = 1e3 * shots_s / shots;
    state.counters["tree_per_shot"] = (tree_s / runs) / (shots_s / shots);
    state.counters["iterations"] = iterations / shots;
    state.counters["reached"] = reached / shots;
}
BENCHMARK_CAPTURE(connect_torus, geodesic_10k, 9.5, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(connect_torus, steered_10k, 9.5, 0.2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(connect_torus, geodesic_100k_large, 3.0, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(connect_torus, steered_100k_large, 3.0, 0.2)->Unit(benchmark::kMillisecond);

}  // namespace
