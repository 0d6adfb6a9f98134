#include "pipeline/wind_layer.h"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "core/counted.h"
#include "core/text/text_number.h"
#include "pipeline/pattern_checks.h"
#include "pipeline/plan_layer.h"
#include "pipeline/run_names.h"
#include "postproc/verify/check_kinds.h"
#include "postproc/verify/laydown.h"

namespace meshwind {
namespace {

// Puts pins on the mandrel; none, with the reason, where fibre cannot turn on pins.
std::vector<PinStand> put_stands(Setup& setup, std::string& failure) {
    const Job::MandrelJob& job = setup.job.mandrel;
    const double most_mm =
        job.extension_given ? job.extension_mm : std::numeric_limits<double>::infinity();
    std::vector<PinStand> stands =
        stand_pins(setup.mandrel.rims, job.pins, planned_tow(setup), most_mm, failure);
    put_pins(setup, rings_of(stands));
    return stands;
}

// How the layer is planned on the mandrel as it is.
LayerPlanOptions plan_options(const WindLayerOptions& options) {
    LayerPlanOptions plan;
    plan.context = options.context;
    plan.bare = options.bare;
    plan.build_up_mm = options.build_up_mm;
    plan.least_covered = options.least_covered;
    plan.least_joined = options.least_joined;
    plan.patterns_first = options.patterns_first;
    plan.stage = options.stage;
    plan.before = options.before != nullptr ? &options.before->plan : nullptr;
    return plan;
}

// Pins that have to stand before are put on the layer's mandrel.
PlannedLayer plan_of_courses(WoundLayer& layer, const LayerMachine& machine,
                             const WindLayerOptions& options) {
    PlannedLayer planned;
    LayerPlanOptions plan = plan_options(options);
    if (needs_pins_first(layer.setup, layer.job, plan)) {
        planned.plan.planner = Planner::Cover;
        plan.pins = put_stands(layer.setup, planned.plan.failure);
    }
    return planned.plan.failure.empty() ? plan_layer(layer.setup, layer.job, machine, plan)
                                        : std::move(planned);
}

PlannedLayer plan_of_points(WoundLayer& layer, const WindLayerOptions& options) {
    options.context.report_progress("plan", 0.0);
    PlannedLayer planned;
    planned.plan =
        import_plan(layer.setup, *options.import, options.context.seed, layer.import.emplace());
    return planned;
}

// Gives the layer its plan, and its mandrel the pins of that.
void take_plan(PlannedLayer& planned, const WindLayerOptions& options, WoundLayer& layer) {
    Plan& plan = layer.plan;
    plan = std::move(planned.plan);
    layer.no_pattern = std::move(planned.no_pattern);
    if (!plan.pins.empty() && layer.setup.pins.empty()) {
        put_pins(layer.setup, plan.pins);
    }
    if (options.before != nullptr && !plan.continues_fibre && plan.cut_reason.empty()) {
        plan.cut_reason = std::string("plans of the kind \"") + name_of(plan.planner) +
                          "\" are not led on from another layer";
    }
}

// Those that the planner has had made, else of the plan.
std::vector<FibreProgram> programs_of(const Plan& plan, const LayerMachine& machine,
                                      TrialWinding* trial) {
    if (auto* programs = dynamic_cast<LayerPrograms*>(trial)) {
        return std::move(programs->programs);
    }
    return std::move(machine.programs_of(plan, true)->programs);
}

Check fibres_check(const Plan& plan, int most_fibres) {
    Check check(check_kind::kContinuity, plan.fibres <= most_fibres);
    check.numbers = {{"fibres", static_cast<double>(plan.fibres)},
                     {"limit", static_cast<double>(most_fibres)},
                     {"worst_joint_mm", plan.worst_joint_mm}};
    if (!check.ok) {
        check.words =
            "the plan takes " + std::to_string(plan.fibres) +
            " separate fibres; a slimmer head, less clearance, a longer extension or more "
            "friction gives more courses to join them";
    }
    return check;
}

// Points too far off are refused before; how far they were tells of their mandrel.
Check import_check(const ImportFit& fit) {
    Check check(check_kind::kImport);
    check.numbers = {{"worst_mm", fit.worst_mm},
                     {"mean_mm", fit.mean_mm},
                     {"limit_mm", fit.limit_mm},
                     {"worst_line", static_cast<double>(fit.worst_line)}};
    return check;
}

// ": 12.3 cm2 are bare, for ..." with the reason that keeps most wall bare.
std::string largest_bare_wall(const Plan& plan) {
    std::map<std::string, double> area_mm2;
    for (const Uncovered& bare : plan.uncovered) {
        area_mm2[bare.rule] += bare.area_mm2;
    }
    const auto largest =
        std::max_element(area_mm2.begin(), area_mm2.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    return largest == area_mm2.end() ? ""
                                     : "; " + fixed(largest->second / 100.0, 2) +
                                           " cm2 are bare for this: " + largest->first;
}

std::string those_joined(const Coverage& coverage, int fibres) {
    const std::optional<double>& joinable = coverage.joinable;
    return joinable ? ", those that " + counted(fibres, "fibre") + " can join " +
                          fixed(100.0 * *joinable, 1) + " %"
                    : std::string();
}

// On the face that misses the most.
CheckPlace barest_place(const Surface& surface, const std::vector<double>& layers) {
    std::size_t barest = 0;
    double most_mm2 = -1.0;
    for (std::size_t f = 0; f < layers.size(); ++f) {
        const double bare_mm2 =
            area_mm2(surface.position_mm, surface.face[f]) * (1.0 - std::min(1.0, layers[f]));
        if (bare_mm2 > most_mm2) {
            most_mm2 = bare_mm2;
            barest = f;
        }
    }
    return {.position_mm = position_mm(surface, {.face = static_cast<std::int32_t>(barest)})};
}

Check coverage_check(const Setup& setup, const Plan& plan) {
    if (is_open(plan)) {
        return open_coverage_check(plan);
    }
    const Coverage& coverage = plan.coverage;
    const double limit = least_covered(coverage, setup.job.tolerance.bare);
    Check check(check_kind::kCoverage, coverage.fraction >= limit);
    check.numbers = {{"limit", limit}, {"fraction", coverage.fraction}};
    check.place = barest_place(setup.mandrel.surface, plan.face_layers);
    if (!check.ok) {
        check.words = "only " + fixed(100.0 * coverage.fraction, 1) +
                      " % of the wall is covered although single courses reach " +
                      fixed(100.0 * coverage.reachable, 1) + " %" +
                      those_joined(coverage, setup.job.fibres) + largest_bare_wall(plan);
    }
    return check;
}

std::string place_of(const EyePoint& eye) {
    const Eigen::Vector3d& p = eye.landing_mm;
    return "piece " + std::to_string(eye.piece) + ", point " + std::to_string(eye.point) + " at (" +
           fixed(p.x(), 1) + ", " + fixed(p.y(), 1) + ", " + fixed(p.z(), 1) + ")";
}

Check eye_check(const PieceProgram& made) {
    const std::vector<std::size_t>& blocked = made.eyes.blocked;
    Check check(check_kind::kEye, blocked.empty());
    check.numbers = {{"blocked_points", static_cast<double>(blocked.size())}};
    if (!check.ok) {
        check.words = made.eyes.words + " at " + place_of(made.eyes.path[blocked.front()]);
        check.place = {.position_mm = made.eyes.path[blocked.front()].landing_mm};
    }
    return check;
}

Check rounding_check(const PieceProgram& made) {
    Check check(check_kind::kRounding, made.read.nano == made.blocks.nano);
    check.numbers["blocks"] = static_cast<double>(made.read.moves());
    if (!check.ok) {
        check.words = "the program read back does not give the positions that were planned";
    }
    return check;
}

std::vector<Check> checks_of(const PieceProgram& made) {
    std::vector<Check> checks{eye_check(made), rounding_check(made)};
    const std::vector<Check>& found = made.verification.checks;
    checks.insert(checks.end(), found.begin(), found.end());
    return checks;
}

void add_program_checks(const std::vector<FibreProgram>& programs, std::vector<Check>& checks) {
    for (std::size_t fibre = 0; fibre < programs.size(); ++fibre) {
        std::vector<Check> found = checks_of(programs[fibre].made);
        for (Check& check : found) {
            check.name += fibre_suffix(fibre);
            if (check.place) {
                check.place->fibre = fibre;
            }
            checks.push_back(std::move(check));
        }
    }
}

void add_closure_checks(const Setup& setup, const Plan& plan, const PieceProgram& made,
                        std::vector<Check>& checks) {
    const std::span<const PathPoint> laid = made.verification.laid.path;
    if (plan.pattern() != nullptr && plan.pattern()->starts_rad.size() > 1) {
        checks.push_back(closure_check(plan, laid));
    }
    if (plan.elbow() != nullptr && plan.elbow()->lines > 1) {
        const LaidPath meant =
            lay_down(*setup.wall, setup.machine, made.exact, *made.exact.tie_on_mm);
        checks.push_back(elbow_closure_check(plan, setup.job.tow.width_mm, laid, meant.path));
    }
}

std::vector<Check> checks_of_layer(const WoundLayer& layer, bool is_stage) {
    const Setup& setup = layer.setup;
    std::vector<Check> checks{fibres_check(layer.plan, setup.job.fibres)};
    if (layer.import) {
        checks.push_back(import_check(*layer.import));
    } else if (!is_stage) {
        checks.push_back(coverage_check(setup, layer.plan));
    }
    add_program_checks(layer.programs, checks);
    add_closure_checks(setup, layer.plan, layer.programs.front().made, checks);
    return checks;
}

// What failed, for the heads of programs that are written by force.
std::vector<std::string> notes_of(const std::vector<Check>& checks) {
    std::vector<std::string> notes;
    for (const Check& check : checks) {
        if (!check.ok) {
            notes.push_back("CHECK FAILED, written by force: " + check.name);
        }
    }
    return notes;
}

// What was laid has been judged; of a long fibre it takes as much memory as the plan.
void forget_laid(PieceProgram& made) {
    LaidPath& laid = made.verification.laid;
    LaidPath kept;
    kept.peeled_mm = laid.peeled_mm;
    kept.peeled_block = laid.peeled_block;
    kept.failure = std::move(laid.failure);
    kept.failed_block = laid.failed_block;
    laid = std::move(kept);
    made.exact = {};
}

void write_programs(const LayerMachine& machine, WoundLayer& layer) {
    const std::vector<std::string> notes = notes_of(layer.checks);
    for (std::size_t fibre = 0; fibre < layer.programs.size(); ++fibre) {
        FibreProgram& program = layer.programs[fibre];
        program.text =
            machine.text_of(program.made, layer.plan.continues_fibre && fibre == 0, notes);
        forget_laid(program.made);
    }
}

LayerMachineOptions machine_options(const WindLayerOptions& options) {
    LayerMachineOptions of_machine;
    of_machine.suffix = options.suffix;
    of_machine.header = options.header;
    of_machine.before = options.before != nullptr ? &options.before->programs.back() : nullptr;
    of_machine.context = options.context;
    of_machine.stage_done = options.stage_done;
    return of_machine;
}

}  // namespace

double WoundLayer::duration_s() const {
    double sum_s = 0.0;
    for (const FibreProgram& program : programs) {
        sum_s += program.made.duration_s;
    }
    return sum_s;
}

void wind_layer(WoundLayer& layer, const WindLayerOptions& options) {
    const LayerMachineOptions of_machine = machine_options(options);
    const LayerMachine machine(layer.setup, of_machine);
    PlannedLayer planned =
        options.import ? plan_of_points(layer, options) : plan_of_courses(layer, machine, options);
    take_plan(planned, options, layer);
    if (options.stage_done) {
        options.stage_done("plan");
    }
    if (!layer.plan.failure.empty()) {
        layer.checks.emplace_back(check_kind::kPlan, false, layer.plan.failure);
        return;
    }
    layer.programs = programs_of(layer.plan, machine, planned.trial.get());
    layer.checks = checks_of_layer(layer, options.stage != nullptr);
    write_programs(machine, layer);
}

}  // namespace meshwind
