/// How much the courses of a cover are annealed, and at what prices.
#pragma once

#include "winding/cover/anneal.h"

namespace meshwind {

/// What the annealing is for.
struct CoverAnnealing {
    bool last_stage = true;     ///< of a wall; thin places are filled later behind others
    bool angle_wanted = false;  ///< the courses come of no bound of the fibre
    bool spare_fibres = false;  ///< courses may lead on where none leads back
    bool mending = false;       ///< a few courses are missing
    double effort = 1.0;
};

/// Numbers of the options; what is specific to a plan is left open.
[[nodiscard]] AnnealOptions annealing_of(const CoverAnnealing& cover);

}  // namespace meshwind
