// The tracer and the freezing of a surface on irregular tori of real part sizes.
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>
#include <Eigen/Geometry>

#include "core/units.h"
#include "geodesic/trace.h"
#include "mesh/edge_table.h"
#include "mesh/feature_edges.h"
#include "mesh/make_kinds.h"
#include "mesh/rims.h"

namespace {

constexpr double kPath_mm = 600.0;
constexpr std::size_t kPaths = 64;

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

Parts torus_parts(double edge_mm) {
    Parts parts;
    parts.soup = meshwind::make_mandrel("torus", {}, {.edge_mm = edge_mm, .irregular = true});
    const auto neighbours = meshwind::face_neighbours(parts.soup.faces);
    parts.feature =
        meshwind::feature_edges(meshwind::steady_normals(parts.soup, neighbours), neighbours);
    parts.region.assign(parts.soup.faces.size(), 0);
    parts.rims = meshwind::find_rims(parts.soup);
    return parts;
}

// Frozen once per size: freezing a million triangles takes longer than any case.
const meshwind::Surface& torus(double edge_mm) {
    static std::map<double, meshwind::Surface> made;
    const auto known = made.find(edge_mm);
    return known != made.end() ? known->second
                               : made.emplace(edge_mm, torus_parts(edge_mm).freeze()).first->second;
}

/// 64 paths of 600 mm from random faces, fixed seed; items are stations, nearly all edge crossings.
void trace_torus(benchmark::State& state, double edge_mm, double slip_ratio) {
    const meshwind::Surface& surface = torus(edge_mm);
    std::mt19937_64 random(1);
    std::uniform_int_distribution<std::int32_t> face(
        0, static_cast<std::int32_t>(surface.face.size()) - 1);
    std::uniform_real_distribution<double> turn(0.0, 2.0 * meshwind::kPi);
    std::vector<meshwind::SurfacePoint> starts;
    std::vector<Eigen::Vector3d> directions;
    for (std::size_t i = 0; i < kPaths; ++i) {
        starts.push_back({.face = face(random)});
        const Eigen::Vector3d n = meshwind::smooth_normal(surface, starts.back());
        const Eigen::Vector3d x = n.unitOrthogonal();
        const double angle = turn(random);
        directions.emplace_back(std::cos(angle) * x + std::sin(angle) * n.cross(x));
    }
    std::size_t stations = 0;
    for (auto _ : state) {
        for (std::size_t i = 0; i < kPaths; ++i) {
            const auto result =
                meshwind::trace(surface, starts[i], directions[i], {slip_ratio, slip_ratio},
                                {.max_length_mm = kPath_mm});
            stations += result.path.size();
        }
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(stations));
    state.counters["triangles"] = static_cast<double>(surface.face.size());
}
BENCHMARK_CAPTURE(trace_torus, geodesic_10k, 9.5, 0.0);
BENCHMARK_CAPTURE(trace_torus, steered_10k, 9.5, 0.1);
BENCHMARK_CAPTURE(trace_torus, geodesic_100k, 3.0, 0.0);
BENCHMARK_CAPTURE(trace_torus, steered_100k, 3.0, 0.1);
BENCHMARK_CAPTURE(trace_torus, geodesic_1M_large, 0.96, 0.0);
BENCHMARK_CAPTURE(trace_torus, steered_1M_large, 0.96, 0.1);

/// Adjacency, corners and cubic fits; items are triangles.
void freeze_torus(benchmark::State& state, double edge_mm) {
    const Parts parts = torus_parts(edge_mm);
    for (auto _ : state) {
        benchmark::DoNotOptimize(parts.freeze());
    }
    state.SetItemsProcessed(state.iterations() *
                            static_cast<std::int64_t>(parts.soup.faces.size()));
}
BENCHMARK_CAPTURE(freeze_torus, 10k, 9.5)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(freeze_torus, 100k, 3.0)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(freeze_torus, 1M_large, 0.96)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
