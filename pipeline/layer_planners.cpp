#include "pipeline/layer_planners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/tube/grown_tube.h"
#include "winding/cover/cover.h"
#include "winding/elbow/elbow_plan.h"
#include "winding/revolution/hoop_path.h"
#include "winding/revolution/pattern_plan.h"

namespace meshwind {
namespace {

// Winding angles at the widest place that a helical layer without one is tried with.
constexpr double kFirstAngle_deg = 45.0;
constexpr double kLastAngle_deg = 80.0;
constexpr double kAngleStep_deg = 5.0;

// Where a narrow end lets none of those by, or they leave a neck bare. Angles are closer there: the
// path crosses the corner of a neck ever flatter.
constexpr double kFlattest_deg = 10.0;
constexpr double kFlatter_deg = 2.5;

// So many times the layers on average of the thinnest pattern: the angle counts for more.
constexpr double kHardlyMore = 1.3;

// Patterns that the machine refuses although it winds circuits of them: each takes a whole winding.
constexpr int kMaxRefused = 3;

// Polar windings and flat helices leave necks and poles bare: where these cover less than this,
// others are looked for.
constexpr double kPolarCovers = 0.95;

// A pattern that covers less is looked for at smaller angles.
constexpr double kWholeWall = 0.99;

// Radii at which the circuits of a stage of a wall are tried to turn back.
constexpr int kMaxTurnsTried = 4;

// A whole number of layers is meant, not one more.
constexpr double kSameLayers = 1e-9;

TriedPlan untried(Plan plan) {
    return {std::move(plan), nullptr};
}

// A plan that covers too little is none.
Plan covering(Plan plan) {
    if (plan.failure.empty() && plan.coverage.fraction < kCoveredShare) {
        plan.failure = "the pattern covers too little";
    }
    return plan;
}

PatternKind pattern_of(LayerKind kind) {
    switch (kind) {
        case LayerKind::Polar:
            return PatternKind::Polar;
        case LayerKind::Hoop:
            return PatternKind::Hoop;
        default:
            return PatternKind::Helical;
    }
}

// Circuits lie in both hands: a cover of theirs is two layers.
double covers_of(double target_layers) {
    return std::max(1.0, std::ceil(0.5 * target_layers - kSameLayers));
}

PatternConstraints wish_of(const PatternJob& job) {
    PatternConstraints wish;
    wish.circuits = job.circuits;
    wish.starts = job.starts;
    wish.order = job.lead;
    wish.most_overlap = job.most_overlap;
    wish.least_dwell_rad = rad_from_deg(job.dwell_deg);
    if (job.most_dwell_deg) {
        wish.most_dwell_rad = rad_from_deg(*job.most_dwell_deg);
    }
    wish.band_offset_mm = job.band_offset_mm;
    return wish;
}

// Heights between which a bare body is a cylinder, at its widest place.
std::optional<std::array<double, 2>> cylinder_of(const Mandrel& bare) {
    const RevolutionFinding found = find_revolution(bare);
    if (!found.body) {
        return std::nullopt;
    }
    const Meridian& meridian = found.body->meridian;
    const CylinderPart part = cylinder_at(meridian, meridian.widest_mm());
    if (part.from_mm == part.to_mm) {
        return std::nullopt;
    }
    return std::array{meridian.at(part.from_mm).z_mm, meridian.at(part.to_mm).z_mm};
}

// Patterns of bodies of revolution.

bool makes_patterns(LayerKind kind) {
    return kind != LayerKind::Cover;
}

std::string why_no_body(const LayerTask& task) {
    const RevolutionFinding& found = task.revolution();
    return found.body ? std::string()
                      : "patterns are wound on bodies of revolution, helical ones on elbows, too, "
                        "and this is none: " +
                            found.why_not + "; use \"cover\"";
}

PatternOptions pattern_options(const LayerTask& task, PatternKind kind, double angle_rad) {
    const Job& job = task.setup.job;
    PatternOptions pattern;
    pattern.kind = kind;
    pattern.angle_rad = angle_rad;
    pattern.layers =
        kind == PatternKind::Hoop ? task.layer.target_layers : covers_of(task.layer.target_layers);
    pattern.tow = planned_tow(task.setup);
    pattern.turn.extension_mm = job.mandrel.extension_mm;
    if (kind == PatternKind::Hoop && task.options.bare != nullptr) {
        pattern.hoop_z_mm = cylinder_of(*task.options.bare);
    }
    if (task.options.before != nullptr) {
        pattern.before = fibre_end_of(*task.options.before);
    }
    pattern.context = task.options.context;
    pattern.lattice = task.layer.lattice;
    pattern.turns = [&job](const Tow& tow, double extension_mm) {
        return traits_of(job.mandrel.turn).turns(job, tow, extension_mm);
    };
    if (task.layer.pattern) {
        pattern.wish = wish_of(*task.layer.pattern);
    }
    return pattern;
}

Plan plan_pattern_of(const LayerTask& task, PatternKind kind, double angle_rad) {
    return plan_pattern(task.setup.mandrel, *task.revolution().body,
                        pattern_options(task, kind, angle_rad));
}

// Of a stage of a wall: the radius at which, from the poles out, the wall first wants a layer, but
// for what may lack. Nearer to the poles the circuits of the stages before have piled up.
double first_wanting_mm(const Surface& surface, const StageAsk& stage) {
    std::vector<double> radius_mm;
    for (std::size_t i = 0; i < stage.measured.at.size(); ++i) {
        if (stage.left[i] > 0) {
            const Eigen::Vector3d place = position_mm(surface, stage.measured.at[i]);
            radius_mm.push_back(std::hypot(place.x(), place.y()));
        }
    }
    const auto may_lack = static_cast<std::ptrdiff_t>(
        stage.filled_to * static_cast<double>(stage.measured.at.size()));
    if (static_cast<std::ptrdiff_t>(radius_mm.size()) <= may_lack) {
        return 0.0;
    }
    const auto first = radius_mm.begin() + may_lack;
    std::nth_element(radius_mm.begin(), first, radius_mm.end());
    return *first;
}

bool is_wound(const TriedPlan& tried) {
    return tried.trial != nullptr && tried.trial->refused.empty();
}

// What turns on pins, which are yet to be put on the mandrel, is not wound. Nor is what covers
// less than may be asked of patterns: it fails.
TriedPlan wound(const LayerTask& task, Plan plan) {
    TriedPlan tried = untried(std::move(plan));
    const double share = tried.plan.coverage.fraction;
    if (task.options.patterns_first && tried.plan.failure.empty() &&
        share < task.options.least_covered) {
        tried.plan.failure = "the pattern covers " + percent(share, 1) + " of the wall";
    }
    if (tried.plan.failure.empty() && tried.plan.pins.empty()) {
        tried.trial = task.machine.wind_all(tried.plan);
    }
    return tried;
}

// How the machine is asked for the first circuits of a pattern.
using Asked = CourseFault (Windability::*)(std::span<const Piece>) const;

// Of `auto`: it covers, and the machine winds the first circuits of it.
Plan pattern_at(const LayerTask& task, PatternKind kind, double angle_rad,
                Asked asked = &Windability::wind_alone) {
    PatternOptions options = pattern_options(task, kind, angle_rad);
    options.least_covered = kCoveredShare;
    options.winds = [&task, asked](std::span<const Piece> circuits) {
        return (task.machine.*asked)(circuits);
    };
    return covering(plan_pattern(task.setup.mandrel, *task.revolution().body, options));
}

bool can_be_laid(const TriedPlan& tried) {
    return is_wound(tried) || (tried.plan.failure.empty() && !tried.plan.pins.empty());
}

// Of the wall that counts: beyond that all of it is covered.
double covered_share(const Plan& plan) {
    return std::min(plan.coverage.fraction, kWholeWall);
}

double angle_rad_of(const Plan& plan) {
    return std::get<LaidPattern>(plan.details).angle_rad;
}

// Of those that cover most, and with hardly more layers than the thinnest, the nearest to the usual
// angle goes first; others by the layers that they lay.
void sort_by_worth(std::vector<Plan>& plans) {
    double most = 0.0;
    for (const Plan& plan : plans) {
        most = std::max(most, covered_share(plan));
    }
    double thinnest = std::numeric_limits<double>::max();
    for (const Plan& plan : plans) {
        thinnest =
            covered_share(plan) < most ? thinnest : std::min(thinnest, plan.coverage.mean_layers);
    }
    const auto rank = [&](const Plan& plan) {
        const bool good =
            covered_share(plan) == most && plan.coverage.mean_layers <= kHardlyMore * thinnest;
        return std::tuple(good ? 0 : 1,
                          good ? std::abs(angle_rad_of(plan) - rad_from_deg(kFirstAngle_deg)) : 0.0,
                          -covered_share(plan), plan.coverage.mean_layers);
    };
    std::stable_sort(plans.begin(), plans.end(),
                     [&](const Plan& a, const Plan& b) { return rank(a) < rank(b); });
}

// Where the flattest pattern leaves much of the wall bare, adds flatter ones with free lengths that
// take long to find, as far as there are any.
void add_flatter(const LayerTask& task, std::vector<Plan>& plans) {
    if (plans.empty() || covered_share(plans.back()) >= kPolarCovers) {
        return;
    }
    for (double angle_deg = deg_from_rad(angle_rad_of(plans.back())) - kFlatter_deg;
         angle_deg >= kFlattest_deg; angle_deg -= kFlatter_deg) {
        Plan plan = pattern_at(task, PatternKind::Helical, rad_from_deg(angle_deg),
                               &Windability::wind_circuits);
        if (!plan.failure.empty()) {
            return;
        }
        plans.push_back(std::move(plan));
    }
}

// Patterns whose circuits the machine winds, the best first; a plan that failed for want of one.
std::vector<Plan> helical_patterns(const LayerTask& task, double steepest_deg) {
    std::vector<Plan> plans;
    Plan failed;
    for (double angle_deg = steepest_deg; angle_deg >= kFlattest_deg;
         angle_deg -= angle_deg > kFirstAngle_deg ? kAngleStep_deg : kFlatter_deg) {
        Plan plan = pattern_at(task, PatternKind::Helical, rad_from_deg(angle_deg));
        if (plan.failure.empty()) {
            plans.push_back(std::move(plan));
        } else if (angle_deg >= kFirstAngle_deg || failed.failure.empty()) {
            failed = std::move(plan);
        }
    }
    add_flatter(task, plans);
    sort_by_worth(plans);
    if (plans.empty()) {
        plans.push_back(std::move(failed));
    }
    return plans;
}

// A fibre at none of the usual angles comes there by itself: it is steered, and piles up.
bool has_narrow_end(const LayerTask& task) {
    const Meridian& meridian = task.revolution().body->meridian;
    const double least_mm =
        meridian.at(meridian.widest_mm()).radius_mm * std::sin(rad_from_deg(kFirstAngle_deg));
    return std::min(meridian.at(0.0).radius_mm, meridian.at(meridian.length_mm()).radius_mm) <
           least_mm;
}

// Polar where both ends are narrow openings, else helical by the smallest of the usual angles that
// holds; where an end is narrow, that leaves wall bare or none holds, by the best of all.
TriedPlan plan_from_rim_to_rim(const LayerTask& task) {
    TriedPlan best = wound(task, pattern_at(task, PatternKind::Polar, 0.0));
    if (can_be_laid(best) && best.plan.coverage.fraction >= kPolarCovers) {
        return best;
    }
    int refused = 0;
    const auto try_one = [&](Plan plan) {
        TriedPlan tried = wound(task, std::move(plan));
        refused += tried.trial != nullptr && !is_wound(tried) ? 1 : 0;
        const bool laid = can_be_laid(tried);
        const bool covers_less = tried.plan.coverage.fraction < best.plan.coverage.fraction;
        if (laid || !(can_be_laid(best) || (task.options.patterns_first && covers_less))) {
            best = std::move(tried);
        }
        return laid;
    };
    const bool narrow = has_narrow_end(task);
    for (double angle_deg = kFirstAngle_deg;
         !narrow && !can_be_laid(best) && refused < kMaxRefused && angle_deg <= kLastAngle_deg;
         angle_deg += kAngleStep_deg) {
        try_one(pattern_at(task, PatternKind::Helical, rad_from_deg(angle_deg)));
    }
    if (can_be_laid(best) && best.plan.coverage.fraction >= kWholeWall) {
        return best;
    }
    const double steepest_deg = narrow ? kLastAngle_deg : kFirstAngle_deg - kAngleStep_deg;
    for (Plan& plan : helical_patterns(task, steepest_deg)) {
        const bool better = !can_be_laid(best) || covered_share(plan) > covered_share(best.plan);
        if (!better || refused >= kMaxRefused || try_one(std::move(plan))) {
            break;
        }
    }
    return best;
}

// Circuits of a stage of a wall turn back where it first wants a layer; where that is at a rim they
// are those of a whole wall. What cannot be wound, over what has piled up at the poles, turns back
// the sooner, by a tow width each time.
TriedPlan plan_stage_in_patterns(const LayerTask& task) {
    const Mandrel& mandrel = task.setup.mandrel;
    const Meridian& meridian = task.revolution().body->meridian;
    const double widest_mm = meridian.at(meridian.widest_mm()).radius_mm;
    const double width_mm = task.setup.job.tow.width_mm;
    double beyond_rims_mm = 0.0;
    for (const Rim& rim : mandrel.rims) {
        beyond_rims_mm = std::max(beyond_rims_mm, rim.radius_mm + width_mm);
    }
    double turn_mm = first_wanting_mm(mandrel.surface, *task.options.stage);
    TriedPlan tried;
    for (int tries = 0; tries < kMaxTurnsTried && (tries == 0 || turn_mm <= widest_mm); ++tries) {
        const bool at_rim = turn_mm < beyond_rims_mm;
        const double sine = std::min(turn_mm / widest_mm, std::sin(rad_from_deg(kLastAngle_deg)));
        tried = at_rim ? plan_from_rim_to_rim(task)
                       : untried(plan_pattern_of(task, PatternKind::Helical, std::asin(sine)));
        if (!tried.plan.pins.empty()) {  // that are yet to be put on the mandrel
            break;
        }
        if (tried.plan.failure.empty() && tried.trial == nullptr) {
            tried.trial = task.machine.wind_all(tried.plan);
        }
        if (is_wound(tried)) {
            break;
        }
        turn_mm = at_rim ? beyond_rims_mm : turn_mm + width_mm;
    }
    return tried;
}

// Of `auto`: by the angle asked for, else by one that is found.
TriedPlan plan_pattern_layer(const LayerTask& task) {
    const LayerJob& layer = task.layer;
    if (layer.kind != LayerKind::Auto) {
        return untried(plan_pattern_of(task, pattern_of(layer.kind),
                                       rad_from_deg(layer.angle_deg.value_or(kFirstAngle_deg))));
    }
    if (layer.angle_deg) {
        return untried(
            covering(plan_pattern_of(task, PatternKind::Helical, rad_from_deg(*layer.angle_deg))));
    }
    return task.options.stage != nullptr ? plan_stage_in_patterns(task)
                                         : plan_from_rim_to_rim(task);
}

// Lines of elbows.

bool makes_elbows(LayerKind kind) {
    return kind == LayerKind::Helical;
}

std::string why_no_tube(const LayerTask& task) {
    if (traits_of(task.setup.job.mandrel.turn).reads_pins) {
        return "the lines of an elbow turn by friction; use \"cover\" to turn on pins";
    }
    return task.tube().tube ? std::string() : task.tube().why_not;
}

TriedPlan plan_elbow_layer(const LayerTask& task) {
    const LayerJob& layer = task.layer;
    if (layer.pattern) {
        Plan plan;
        plan.planner = Planner::Elbow;
        plan.failure =
            "\"pattern\" says how circuits of a body of revolution close; the lines of an elbow "
            "follow from its bend, so leave it out";
        return untried(std::move(plan));
    }
    ElbowPlanOptions elbow;
    if (layer.angle_deg) {
        elbow.angle_rad = rad_from_deg(*layer.angle_deg);
    }
    elbow.layers = covers_of(layer.target_layers);
    elbow.tow = planned_tow(task.setup);
    elbow.turn.extension_mm = task.setup.job.mandrel.extension_mm;
    elbow.context = task.options.context;
    elbow.on_layers = task.options.bare != nullptr;
    Plan plan = plan_elbow(task.setup.mandrel, *task.tube().tube, elbow);
    if (task.options.before != nullptr) {
        plan.cut_reason = "the lines of an elbow are not led on from another layer";
    }
    return untried(layer.kind == LayerKind::Auto ? covering(std::move(plan)) : std::move(plan));
}

// Courses that cover any part.

bool makes_covers(LayerKind kind) {
    return kind == LayerKind::Cover;
}

std::string fits_all(const LayerTask& /*task*/) {
    return {};
}

TriedPlan plan_cover_layer(const LayerTask& task) {
    const Setup& setup = task.setup;
    CoverOptions cover;
    cover.tow = planned_tow(task.setup);
    cover.turns.rule.extension_mm = setup.job.mandrel.extension_mm;
    cover.turns.pins = task.options.pins;
    cover.free_fibre = setup.rule.free_fibre;
    cover.select.target_layers = static_cast<int>(std::ceil(task.layer.target_layers));
    if (task.layer.angle_deg) {
        cover.angle_rad = rad_from_deg(*task.layer.angle_deg);
    }
    cover.fibres = setup.job.fibres;
    cover.context = task.options.context;
    cover.least_covered = task.options.least_covered;
    cover.least_joined = task.options.least_joined;
    cover.stage = task.options.stage;
    cover.most_bare = task.setup.job.tolerance.bare;
    return plan_cover(setup.mandrel, *setup.obstacles, cover, &task.machine);
}

constexpr std::array kPlanners{
    LayerPlanner{Planner::Pattern, makes_patterns, why_no_body, plan_pattern_layer},
    LayerPlanner{Planner::Elbow, makes_elbows, why_no_tube, plan_elbow_layer},
    LayerPlanner{Planner::Cover, makes_covers, fits_all, plan_cover_layer},
};

}  // namespace

const RevolutionFinding& LayerTask::revolution() const {
    if (!found_revolution) {
        found_revolution = find_revolution(setup.mandrel);
    }
    return *found_revolution;
}

const TubeFinding& LayerTask::tube() const {
    if (!found_tube) {
        found_tube = find_tube(options.bare == nullptr ? setup.mandrel : *options.bare);
        if (options.bare != nullptr && found_tube->tube) {
            found_tube = grown_tube(*found_tube->tube, setup.mandrel, options.build_up_mm);
        }
    }
    return *found_tube;
}

std::span<const LayerPlanner> layer_planners() {
    return kPlanners;
}

}  // namespace meshwind
