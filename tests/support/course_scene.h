/// What candidates are judged by, for the tests of winding/cover.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/units.h"
#include "mesh/mandrel.h"
#include "mesh/ray_query.h"
#include "tests/support/fixtures.h"
#include "winding/cover/library.h"
#include "winding/laminate/footprint.h"
#include "winding/laminate/samples.h"

namespace meshwind::test {

/// Everything that candidates are judged by, on one mandrel: bands of 10 mm.
struct CourseScene {
    /// \param table_mm see obstacles_of()
    CourseScene(Mandrel loaded, double friction, double table_mm = 0.0)
        : mandrel(std::move(loaded)),
          obstacles(obstacles_of(mandrel, kExtension_mm, table_mm)),
          samples(sample_surface(mandrel.surface, kSpacing_mm, 1)),
          footprints(mandrel.surface, samples, kBand_mm),
          rules{mandrel, obstacles, footprints, {}, {}, {}} {
        rules.tow.width_mm = kBand_mm;
        rules.tow.friction = friction;
        rules.turns.rule = {
            .friction = friction, .extension_mm = kExtension_mm, .band_mm = kBand_mm};
        rules.free_fibre.start_mm = 2.0 * mandrel.surface.mean_edge_mm;
        rules.max_half_length_mm = 2000.0;
    }

    /// Through samples drawn at random, in any direction.
    /// \param steering share of the friction, to either side or not at all
    [[nodiscard]] std::vector<Candidate> candidates(int count, std::uint64_t seed,
                                                    double steering) const {
        Draw draw(seed);
        std::vector<Candidate> all;
        for (int i = 0; i < count; ++i) {
            const auto sample =
                static_cast<std::size_t>(draw.below(static_cast<std::int32_t>(samples.size())));
            const double slip = rules.tow.friction.share((draw.below(3) - 1) * steering);
            all.push_back({samples.at[sample], draw.between(0.0, kPi), slip});
        }
        return all;
    }

    static constexpr double kBand_mm = 10.0;
    static constexpr double kSpacing_mm = 2.5;
    static constexpr double kExtension_mm = 120.0;

    Mandrel mandrel;
    RayQuery obstacles;
    CoverageSamples samples;
    FootprintFinder footprints;
    CourseRules rules;
};

}  // namespace meshwind::test
