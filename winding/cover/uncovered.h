/// Bare wall with the reason that keeps it bare.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "winding/cover/grow.h"

namespace meshwind {

/// Groups the samples without a layer by region and reason: what became of most courses that pass
/// there, with how many courses that is, or where none passes the last check that a candidate
/// failed. \param rejection per member; None where it could have been laid
/// \param layers per sample
[[nodiscard]] std::vector<Uncovered> uncovered_wall(const Surface& surface,
                                                    const CoverageSamples& samples,
                                                    const Library& library,
                                                    std::span<const Rejection> rejection,
                                                    std::span<const std::int32_t> layers);

}  // namespace meshwind
