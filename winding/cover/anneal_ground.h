/// What the annealing weighs courses on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "winding/cover/grow.h"
#include "winding/cover/library.h"
#include "winding/cover/symmetry.h"
#include "winding/laminate/samples.h"

namespace meshwind {

/// What courses are weighed on: samples of its own, others than those that coverage is measured on,
/// so that what is found to be even was not made so for the very places that are measured.
struct AnnealGround {
    /// \param weighed the samples \param measured those of the members' footprints
    AnnealGround(const CourseRules& rules, CoverageSamples weighed, const CoverageSamples& measured,
                 std::span<const Member> library);

    CoverageSamples samples;
    FootprintFinder footprints;
    FootprintFinder strips;                          ///< of the width that a fit needs
    std::vector<std::vector<std::int32_t>> passing;  ///< per sample: members of the library
    Ways ways;                                       ///< of the library
    MirrorImages images;
};

}  // namespace meshwind
