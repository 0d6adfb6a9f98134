#include "winding/cover/anneal_ground.h"

#include <utility>

#include "core/index.h"
#include "core/parallel.h"
#include "mesh/nearest.h"
#include "winding/cover/fit.h"

namespace meshwind {
namespace {

constexpr std::size_t kSampleChunk = 256;

// The image of a wall that is this near to it makes courses that are near enough: they are judged
// like all others.
constexpr double kSymmetryBands = 0.1;

}  // namespace

AnnealGround::AnnealGround(const CourseRules& rules, CoverageSamples weighed,
                           const CoverageSamples& measured, std::span<const Member> library)
    : samples(std::move(weighed)),
      footprints(rules.mandrel.surface, samples, rules.tow.width_mm),
      strips(rules.mandrel.surface, samples, kStripBands * rules.tow.width_mm),
      passing(samples.size()),
      ways(ways_between_nodes(library)),
      images(rules.mandrel, samples, kSymmetryBands * rules.tow.width_mm) {
    const NearestPoints index(samples.position_mm);
    std::vector<std::int32_t> beside(measured.size(), -1);
    parallel_for(measured.size(), kSampleChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            beside[i] = index.nearest(measured.position_mm[i]);
        }
    });
    for (std::size_t i = 0; i < library.size(); ++i) {
        for (const std::int32_t sample : library[i].footprint) {
            auto& here = passing[at(beside[at(sample)])];
            if (here.empty() || here.back() != static_cast<std::int32_t>(i)) {
                here.push_back(static_cast<std::int32_t>(i));
            }
        }
    }
}

}  // namespace meshwind
