#include "pipeline/trials/judged_run.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/counted.h"
#include "core/text/text_number.h"
#include "postproc/verify/check_kinds.h"

namespace meshwind {
namespace {

// A cover of less of what courses reach does not fail by chance.
constexpr double kCoversMost = 0.75;

// By so much of the wall covers with two seeds differ; by .2 % mostly.
constexpr double kSeedsDiffer = 0.005;

// Pins are made and put on: with them so much more of the wall has to be covered.
constexpr double kWorthPins = 0.03;

// What a run has to cover more than one that asks less: each fibre is a stop of the machine, a
// blend another shape than the file's.
double worth_of(const Run& run, const Run& than) {
    const Job& job = run.layers.front().setup.job;
    const Job& other = than.layers.front().setup.job;
    if (turns_on_pins(job) && !turns_on_pins(other)) {
        return kWorthPins;
    }
    const bool asks_more =
        first_plan(run).fibres > first_plan(than).fibres ||
        job.mandrel.blend_mm.value_or(0.0) > other.mandrel.blend_mm.value_or(0.0);
    return asks_more ? kWorthMore : 0.0;
}

// "2 checks fail: slip, laydown"
std::string failed_words(const std::vector<Check>& checks) {
    std::size_t failed = 0;
    std::string names;
    for (const Check& check : checks) {
        if (!check.ok) {
            ++failed;
            names.append(names.empty() ? ": " : ", ").append(check.name);
        }
    }
    return counted(failed, "check") + (failed == 1 ? " fails" : " fail") + names;
}

}  // namespace

const Plan& first_plan(const Run& run) {
    return run.layers.front().plan;
}

double covered_share(const Run& run) {
    return first_plan(run).coverage.fraction;
}

double can_cover(const Run& run) {
    const std::vector<double>& reach = first_plan(run).reach_of_fibres;
    const Job& job = run.layers.front().setup.job;
    if (reach.empty()) {
        return covered_share(run);
    }
    const std::size_t fibres =
        job.fibres_given ? static_cast<std::size_t>(job.fibres) : reach.size();
    return reach[std::min(fibres, reach.size()) - 1];
}

bool was_too_bare(const Run& run) {
    const Plan& plan = first_plan(run);
    return !plan.failure.empty() && plan.coverage.fraction > 0.0;
}

bool joins_enough(const Run& run) {
    const Plan& plan = first_plan(run);
    return was_too_bare(run) && plan.planner == Planner::Cover &&
           can_cover(run) >= kMinReach * plan.coverage.reachable;
}

bool stands(const Run& run) {
    return run.planned() && run.passed();
}

bool turns_on_pins(const Job& job) {
    return traits_of(job.mandrel.turn).reads_pins;
}

bool is_better(const Run& run, const Run& than) {
    if (stands(run) != stands(than)) {
        return stands(run);
    }
    if (run.planned() != than.planned()) {
        return run.planned();
    }
    const double worth = stands(run) ? worth_of(run, than) : 0.0;
    return covered_share(run) > covered_share(than) + worth;
}

bool fails_by_chance(const Run& run) {
    const Plan& plan = first_plan(run);
    if (plan.planner != Planner::Cover || !run.walls.empty() || !run.planned() || run.passed()) {
        return false;
    }
    const bool covers_alone = std::all_of(
        run.checks.begin(), run.checks.end(),
        [](const Check& check) { return check.ok || check.name == check_kind::kCoverage.name; });
    const double bare = run.layers.front().setup.job.tolerance.bare;
    return plan.coverage.fraction >= (covers_alone
                                          ? least_covered(plan.coverage, bare) - kSeedsDiffer
                                          : kCoversMost * plan.coverage.reachable);
}

std::string tried_words(const Run& run, std::uint64_t usual_seed) {
    const Job& job = run.layers.front().setup.job;
    const std::string seed =
        run.seed == usual_seed ? "" : "seed " + std::to_string(run.seed) + ", ";
    return "with " + seed + std::to_string(job.fibres) + (job.fibres == 1 ? " fibre" : " fibres") +
           (turns_on_pins(job) ? ", turns on pins" : "") + ", extensions of " +
           fixed(job.mandrel.extension_mm, 0) + " mm and " +
           (job.mandrel.blend_mm > 0.0 ? "a blend of " + fixed(*job.mandrel.blend_mm, 1) + " mm "
                                       : std::string("no blend ")) +
           percent(covered_share(run), 1) + " of the wall " +
           (was_too_bare(run) ? "can be covered, and nothing is wound"
                              : "is covered, and " + failed_words(run.checks));
}

std::string settings_words(const Job& job) {
    std::string words = "--set fibres=" + std::to_string(job.fibres);
    if (turns_on_pins(job)) {
        words += " --set mandrel.turn=pins";
    }
    words += " --set mandrel.extension=";
    append_shortest(words, job.mandrel.extension_mm);
    if (job.mandrel.blend_mm > 0.0) {
        words += " --set mandrel.blend=";
        append_shortest(words, *job.mandrel.blend_mm);
    }
    return words;
}

}  // namespace meshwind
