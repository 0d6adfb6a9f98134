// What planning spends its time on: judging candidates and finding footprints, on the tee of data/.
#include <cmath>
#include <cstddef>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/random.h"
#include "core/units.h"
#include "mesh/mandrel/extension.h"
#include "mesh/mandrel/load_mandrel.h"
#include "mesh/ray_query.h"
#include "winding/cover/library.h"
#include "winding/laminate/families.h"
#include "winding/laminate/samples.h"

namespace {

using namespace meshwind;

constexpr double kExtension_mm = 100.0;
constexpr double kTable_mm = 100.0;  // clearances are tabulated, as for a plan

struct Scene {
    Scene()
        : mandrel(load_mandrel(MESHWIND_SOURCE_DIR "/data/tee.stl")),
          obstacles(parts()),
          samples(sample_surface(mandrel.surface, 1.5, 1)),
          footprints(mandrel.surface, samples, 6.0),
          rules{mandrel, obstacles, footprints, {}, {}, {}} {
        rules.turns.rule.extension_mm = kExtension_mm;
        rules.free_fibre.start_mm = 2.0 * mandrel.surface.mean_edge_mm;
    }

    [[nodiscard]] RayQuery parts() const {
        std::vector<TriangleSoup> all{mandrel.whole};
        for (const Rim& rim : mandrel.rims) {
            all.push_back(extension_of(rim, kExtension_mm));
        }
        return RayQuery(all, kTable_mm);
    }

    [[nodiscard]] std::vector<Candidate> candidates(std::size_t count) const {
        std::vector<Candidate> all;
        for (std::size_t i = 0; i < count; ++i) {
            const auto sample = random_bits(1, i) % samples.size();
            const double slip = rules.tow.friction.share(0.9 - 1.8 * random_unit(2, i));
            all.push_back({samples.at[sample], kPi * random_unit(3, i), slip});
        }
        return all;
    }

    Mandrel mandrel;
    RayQuery obstacles;
    CoverageSamples samples;
    FootprintFinder footprints;
    CourseRules rules;
};

const Scene& scene() {
    static const Scene tee;
    return tee;
}

void judge_candidates(benchmark::State& state) {
    const std::vector<Candidate> candidates =
        scene().candidates(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        benchmark::DoNotOptimize(build_library(scene().rules, candidates));
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(judge_candidates)->Arg(256)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(judge_candidates)
    ->Name("judge_candidates_large")
    ->Arg(8192)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void build_footprint_finder(benchmark::State& state) {
    for (auto _ : state) {
        benchmark::DoNotOptimize(FootprintFinder(scene().mandrel.surface, scene().samples, 6.0));
    }
}
BENCHMARK(build_footprint_finder)->Unit(benchmark::kMillisecond)->UseRealTime();

void footprint_of_a_path(benchmark::State& state) {
    const SurfacePath path = trace_both_ways(scene().rules, scene().candidates(1).front());
    FootprintFinder::Scratch scratch = scene().footprints.make_scratch();
    for (auto _ : state) {
        benchmark::DoNotOptimize(scene().footprints.footprint(path, scratch));
    }
    state.counters["mm"] = path.empty() ? 0.0 : path.back().s_mm;
}
BENCHMARK(footprint_of_a_path)->Unit(benchmark::kMicrosecond);

// Rings a band apart on one long cylinder, as a pattern of many circuits has them: time grows with
// their number, not with its square.
void families_of_many(benchmark::State& state) {
    constexpr double kBand_mm = 6.0;
    constexpr double kRadius_mm = 40.0;
    std::vector<SurfacePath> rings(static_cast<std::size_t>(state.range(0)));
    std::vector<const SurfacePath*> courses;
    for (std::size_t i = 0; i < rings.size(); ++i) {
        for (double s_mm = 0.0; s_mm < 2.0 * kPi * kRadius_mm; s_mm += 2.0) {
            const double turned = s_mm / kRadius_mm;
            PathPoint point;
            point.normal = {std::cos(turned), std::sin(turned), 0.0};
            point.position_mm = kRadius_mm * point.normal;
            point.position_mm.z() = static_cast<double>(i) * kBand_mm;
            point.tangent = {-std::sin(turned), std::cos(turned), 0.0};
            point.s_mm = s_mm;
            rings[i].push_back(point);
        }
        courses.push_back(&rings[i]);
    }
    for (auto _ : state) {
        benchmark::DoNotOptimize(families_of(courses, kBand_mm));
    }
    state.SetComplexityN(state.range(0));
}
BENCHMARK(families_of_many)->Arg(500)->Arg(2000)->Unit(benchmark::kMillisecond);
BENCHMARK(families_of_many)
    ->Name("families_of_many_large")
    ->RangeMultiplier(4)
    ->Range(2000, 32000)
    ->Complexity()
    ->Unit(benchmark::kMillisecond);

}  // namespace
