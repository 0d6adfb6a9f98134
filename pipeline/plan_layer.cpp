#include "pipeline/plan_layer.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "core/text/text_number.h"
#include "mesh/triangle_soup.h"
#include "pipeline/layer_planners.h"

namespace meshwind {
namespace {

PlannedLayer planned(TriedPlan tried) {
    return {std::move(tried.plan), std::move(tried.trial), {}};
}

PlannedLayer failed(Planner planner, const std::string& why) {
    PlannedLayer layer;
    layer.plan.planner = planner;
    layer.plan.failure = why;
    return layer;
}

// By the first planner that is for the layer's kind and fits the part.
PlannedLayer plan_asked_for(const LayerTask& task) {
    PlannedLayer none;
    for (const LayerPlanner& row : layer_planners()) {
        if (!row.makes(task.layer.kind)) {
            continue;
        }
        const std::string why_not = row.why_not(task);
        if (why_not.empty()) {
            return planned(row.plan(task));
        }
        if (none.plan.failure.empty()) {
            none = failed(row.planner, why_not);
        }
    }
    return none;
}

// On a part that has patterns, for want of one.
PlannedLayer cover_instead(const LayerTask& task, const LayerPlanner& cover,
                           const std::string& why) {
    const Surface& surface = task.setup.mandrel.surface;
    const double tow_mm = task.setup.job.tow.width_mm;
    const double wall_mm2 = area_mm2({surface.position_mm, surface.face});
    if (wall_mm2 > kMaxTowSquares * tow_mm * tow_mm) {
        return failed(Planner::Pattern,
                      "no pattern is laid: " + why + "; a wall of " + fixed(wall_mm2 / 1e6, 3) +
                          " m2 is too large to be covered by single courses of a tow of " +
                          fixed(tow_mm, 1) + " mm instead, unless \"kind\": \"cover\" asks for it");
    }
    // With pins, none stand that courses could use.
    if (task.options.patterns_first || traits_of(task.setup.job.mandrel.turn).reads_pins) {
        return failed(Planner::Pattern, "no pattern is laid: " + why);
    }
    task.options.context.report_remark("no pattern is laid: " + why +
                                       "; courses are planned instead");
    PlannedLayer courses = planned(cover.plan(task));
    courses.no_pattern = why;
    if (!courses.plan.failure.empty()) {
        courses.plan.failure += "; of patterns the last one tried: " + why;
    }
    return courses;
}

// The first plan that covers and that the machine winds; the last planner for want of one.
PlannedLayer plan_best(const LayerTask& task) {
    std::string why;
    Coverage covered;  // by what is the first not to be laid
    const std::span<const LayerPlanner> rows = layer_planners();
    for (const LayerPlanner& row : rows.first(rows.size() - 1)) {
        if (!row.why_not(task).empty()) {
            continue;
        }
        TriedPlan tried = row.plan(task);
        if (!tried.plan.failure.empty()) {
            covered = why.empty() ? tried.plan.coverage : covered;
            why = why.empty() ? tried.plan.failure : why;
            continue;
        }
        if (!tried.plan.pins.empty()) {  // that are yet to be put on the mandrel
            return planned(std::move(tried));
        }
        if (tried.trial == nullptr) {
            tried.trial = task.machine.wind_all(tried.plan);
        }
        const std::size_t refused = tried.trial->refused.size();
        if (refused == 0) {
            return planned(std::move(tried));
        }
        why = std::to_string(refused) + " of " + std::to_string(tried.plan.pieces.size()) +
              " courses and turns of the pattern cannot be wound: " + tried.trial->why;
        break;
    }
    if (why.empty()) {
        return planned(rows.back().plan(task));
    }
    PlannedLayer instead = cover_instead(task, rows.back(), why);
    if (instead.plan.planner == Planner::Pattern) {
        instead.plan.coverage = covered;
    }
    return instead;
}

// Of a stage of a wall what a pattern may lay of it, or else courses.
LayerJob asked_of(const LayerJob& layer, const LayerPlanOptions& options) {
    LayerJob asked = layer;
    if (options.stage != nullptr) {
        asked.kind = options.stage->everywhere < 1.0 ? LayerKind::Cover : LayerKind::Auto;
        asked.target_layers = std::max(1.0, options.stage->everywhere);
    }
    return asked;
}

// Where patterns of bodies of revolution are all that the kind of turn is for.
PlannedLayer plan_in_patterns(const LayerTask& task, std::string_view why) {
    const LayerPlanner& pattern = layer_planners().front();
    if (!pattern.makes(task.layer.kind)) {
        return failed(Planner::None, std::string(why));
    }
    const std::string why_not = pattern.why_not(task);
    return why_not.empty() ? planned(pattern.plan(task)) : failed(pattern.planner, why_not);
}

}  // namespace

PlannedLayer plan_layer(const Setup& setup, const LayerJob& layer, const Windability& machine,
                        const LayerPlanOptions& options) {
    options.context.report_progress("plan", 0.0);
    const LayerJob asked = asked_of(layer, options);
    const LayerTask task{setup, asked, machine, options};
    const std::string_view why_patterns = traits_of(setup.job.mandrel.turn).why_patterns;
    if (!why_patterns.empty()) {
        return plan_in_patterns(task, why_patterns);
    }
    return asked.kind == LayerKind::Auto ? plan_best(task) : plan_asked_for(task);
}

double least_covered(const Coverage& coverage, double bare) {
    const double joinable = coverage.joinable.value_or(coverage.reachable);
    return std::max(0.0, std::max(joinable, kCoveredShare * coverage.reachable) - bare);
}

bool needs_pins_first(const Setup& setup, const LayerJob& layer, const LayerPlanOptions& options) {
    if (!traits_of(setup.job.mandrel.turn).reads_pins) {
        return false;
    }
    const LayerKind kind = asked_of(layer, options).kind;
    return kind == LayerKind::Cover ||
           (kind == LayerKind::Auto && !find_revolution(setup.mandrel).body);
}

}  // namespace meshwind
