#include "pipeline/trials/more_room.h"

#include <algorithm>
#include <vector>

#include "pipeline/plan_layer.h"

namespace meshwind {
namespace {

// Share of the wall that more fibres or longer extensions have to reach.
constexpr double kWorthIt = 0.01;

// To a plan that covers so much of what it has to a fibre to spare may bring the rest.
constexpr double kNearly = 0.95;

// Fibres that are tied on where the machine cannot follow turns. Each is a stop of the machine.
constexpr int kMaxToSpare = 4;

// The fewest fibres that reach what all those that were looked for do.
int fibres_enough(const std::vector<double>& reach) {
    const auto enough = std::find_if(
        reach.begin(), reach.end(), [&](double share) { return share >= reach.back() - kWorthIt; });
    return static_cast<int>(enough - reach.begin()) + 1;
}

bool fibres_are_free(const Job& job, const Plan& plan) {
    return !job.fibres_given && !plan.reach_of_fibres.empty();
}

}  // namespace

std::optional<Job> more_fibres(const Job& job, const Plan& plan) {
    const Coverage& coverage = plan.coverage;
    if (!fibres_are_free(job, plan) ||
        coverage.joinable.value_or(coverage.reachable) + kWorthIt > coverage.reachable) {
        return std::nullopt;
    }
    Job more = job;
    more.fibres = std::max(job.fibres, fibres_enough(plan.reach_of_fibres));
    return more.fibres > job.fibres ? std::optional(std::move(more)) : std::nullopt;
}

std::optional<Job> more_room(const Job& job, const Plan& plan) {
    Job more = job;
    const bool fibres_free = fibres_are_free(job, plan);
    const int enough = fibres_free ? fibres_enough(plan.reach_of_fibres) : 1;
    if (fibres_free) {
        more.fibres = std::max(job.fibres, enough);
    }
    for (const RelaxedRule& what_if : plan.what_if) {
        if (what_if.rule == RelaxedRule::Rule::Extension && !job.mandrel.extension_given &&
            what_if.reachable > plan.coverage.reachable + kWorthIt) {
            more.mandrel.extension_mm *= what_if.factor;
        }
    }
    const auto same = [&] {
        return more.fibres == job.fibres && more.mandrel.extension_mm == job.mandrel.extension_mm;
    };
    // What covers and fails has turns that do not hold, and what nearly covers lacks courses
    // between some rims. Fibres to spare need not take them, and they are tried once: each time is
    // a run of the whole job.
    const bool covers = plan.coverage.fraction >= kNearly * kCoveredShare * plan.coverage.reachable;
    if (same() && fibres_free && covers && job.fibres <= enough) {
        const int spare = std::clamp(plan.effort.turns_refused, 1, kMaxToSpare);
        more.fibres = std::min(job.fibres + spare, kMaxFibres);
    }
    return same() ? std::nullopt : std::optional(std::move(more));
}

}  // namespace meshwind
