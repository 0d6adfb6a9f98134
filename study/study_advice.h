/// Judges the advice of fu_2009_post_processing on mesh size by a study.
#pragma once

#include <string>
#include <vector>

#include "study/study_run.h"

namespace meshwind {

struct Advice {
    std::string claim;
    bool holds = false;
    std::string because;  ///< the numbers that decided
};

/// Decided by the lines of the study where they suffice, else by the law on a helix of 45 degrees
/// (study/helix_law.h). Advice on which neither has numbers is left out.
[[nodiscard]] std::vector<Advice> judged_advice(const StudyOutcome& outcome);

}  // namespace meshwind
