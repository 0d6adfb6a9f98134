#include "winding/plan/plan.h"

#include <algorithm>
#include <numeric>

namespace meshwind {
namespace {

// The first reason is none.
std::size_t commonest(std::span<const std::int64_t> counts) {
    return static_cast<std::size_t>(std::max_element(counts.begin() + 1, counts.end()) -
                                    counts.begin());
}

}  // namespace

CourseFault commonest_rejection(const PlanEffort& effort) {
    return static_cast<CourseFault>(commonest(effort.rejections));
}

std::string refused_most(const PlanEffort& effort) {
    const std::size_t most = commonest(effort.refusals);
    return std::to_string(effort.refusals[most]) + " of " + std::to_string(effort.candidates) +
           " candidates: " + name_of(static_cast<CandidateFault>(most));
}

std::string rejected_most(const PlanEffort& effort) {
    const std::size_t most = commonest(effort.rejections);
    const std::int64_t all =
        std::accumulate(effort.rejections.begin(), effort.rejections.end(), std::int64_t{0});
    return std::to_string(effort.rejections[most]) + " of " + std::to_string(all) + ": " +
           name_of(static_cast<CourseFault>(most));
}

}  // namespace meshwind
