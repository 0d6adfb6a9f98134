/// Choosing courses from the library: cover everything that can be covered, evenly and with little
/// fibre.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "winding/plan/course.h"

namespace meshwind {

struct SelectOptions {
    int target_layers = 1;  ///< each reachable sample is to be covered at least this often
    /// What a sample already covered costs against what a new one earns: fibre laid over fibre is
    /// wasted and makes the wall uneven.
    double overlap_weight = 0.35;
    /// A course that adds less than this share of its own area is not worth its turn.
    double least_gain_share = 0.01;
    /// What fibre off the wanted winding angle costs, against 1 for a layer too many.
    double angle_weight = 4.0;
};

/// Which members are laid, and how often each coverage sample is covered by them.
struct Selection {
    std::vector<std::int32_t> chosen;  ///< indices of members, in the order of choice
    std::vector<std::int32_t> layers;  ///< per sample
};

/// Lazy greedy: always the member with the best (new area - weighted overlap) per fibre; then drops
/// what has become superfluous. \param allowed per member: false keeps it out
/// \param kept members to begin with, all allowed and each once
/// Equal gains go to the lower index, so the answer depends on the library alone.
[[nodiscard]] Selection select_courses(std::span<const Member> members,
                                       std::span<const char> allowed, std::size_t samples,
                                       const SelectOptions& options = {},
                                       std::span<const std::int32_t> kept = {});

}  // namespace meshwind
