#include "pipeline/wind_layer.h"

#include <algorithm>
#include <limits>
#include <map>
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

class LayerWinder {
public:
    LayerWinder(WoundLayer& layer, const WindLayerOptions& options)
        : layer_(layer), setup_(layer.setup), options_(options) {}

    void run() {
        LayerMachineOptions options;
        options.suffix = options_.suffix;
        options.header = options_.header;
        options.before = options_.before != nullptr ? &options_.before->programs.back() : nullptr;
        options.context = options_.context;
        options.stage_done = options_.stage_done;
        const LayerMachine machine(setup_, options);
        std::unique_ptr<TrialWinding> trial = plan(machine);
        if (!layer_.plan.failure.empty()) {
            layer_.checks.emplace_back(check_kind::kPlan, false, layer_.plan.failure);
            return;
        }
        if (auto* programs = dynamic_cast<LayerPrograms*>(trial.get())) {
            layer_.programs = std::move(programs->programs);
        } else {
            layer_.programs = std::move(machine.programs_of(layer_.plan, true)->programs);
        }
        check(machine);
    }

private:
    // Returns the programs where the planner has had them made.
    std::unique_ptr<TrialWinding> plan(const LayerMachine& machine) {
        PlannedLayer planned;
        if (options_.import) {
            options_.context.report_progress("plan", 0.0);
            planned.plan = import_plan(setup_, *options_.import, options_.context.seed,
                                       layer_.import.emplace());
        } else {
            LayerPlanOptions plan;
            plan.context = options_.context;
            plan.bare = options_.bare;
            plan.build_up_mm = options_.build_up_mm;
            plan.least_covered = options_.least_covered;
            plan.least_joined = options_.least_joined;
            plan.patterns_first = options_.patterns_first;
            plan.stage = options_.stage;
            plan.before = options_.before != nullptr ? &options_.before->plan : nullptr;
            if (needs_pins_first(setup_, layer_.job, plan)) {
                planned.plan.planner = Planner::Cover;
                plan.pins = stand_pins(planned.plan.failure);
            }
            if (planned.plan.failure.empty()) {
                planned = plan_layer(setup_, layer_.job, machine, plan);
            }
        }
        layer_.plan = std::move(planned.plan);
        layer_.no_pattern = std::move(planned.no_pattern);
        if (!layer_.plan.pins.empty() && layer_.setup.pins.empty()) {
            put_pins(layer_.setup, layer_.plan.pins);
        }
        if (options_.before != nullptr && !layer_.plan.goes_on && layer_.plan.cut_because.empty()) {
            layer_.plan.cut_because = std::string("plans of the kind \"") +
                                      name_of(layer_.plan.planner) +
                                      "\" are not led on from another layer";
        }
        if (options_.stage_done) {
            options_.stage_done("plan");
        }
        return std::move(planned.trial);
    }

    // Puts them on the mandrel; none, with the reason, where fibre cannot turn on pins.
    std::vector<PinStand> stand_pins(std::string& failure) {
        const Job::MandrelJob& job = setup_.job.mandrel;
        const double most_mm =
            job.extension_given ? job.extension_mm : std::numeric_limits<double>::infinity();
        std::vector<PinStand> stands = meshwind::stand_pins(setup_.mandrel.rims, job.pins,
                                                            planned_tow(setup_), most_mm, failure);
        put_pins(layer_.setup, rings_of(stands));
        return stands;
    }

    [[nodiscard]] static std::string place_of(const EyePoint& eye) {
        const Eigen::Vector3d& p = eye.landing_mm;
        return "piece " + std::to_string(eye.piece) + ", point " + std::to_string(eye.point) +
               " at (" + fixed(p.x(), 1) + ", " + fixed(p.y(), 1) + ", " + fixed(p.z(), 1) + ")";
    }

    void check(const LayerMachine& machine) {
        check_fibres();
        if (layer_.import) {
            check_import();
        } else if (options_.stage == nullptr) {
            check_coverage();
        }
        for (std::size_t fibre = 0; fibre < layer_.programs.size(); ++fibre) {
            std::vector<Check> found = checks_of(layer_.programs[fibre].made);
            for (Check& check : found) {
                check.name += fibre_suffix(fibre);
                if (check.place) {
                    check.place->fibre = fibre;
                }
                layer_.checks.push_back(std::move(check));
            }
        }
        check_closure();
        std::vector<std::string> notes;  // with what failed, for --force
        for (const Check& check : layer_.checks) {
            if (!check.ok) {
                notes.push_back("CHECK FAILED, written by force: " + check.name);
            }
        }
        for (std::size_t fibre = 0; fibre < layer_.programs.size(); ++fibre) {
            FibreProgram& program = layer_.programs[fibre];
            program.text = machine.text_of(program.made, layer_.plan.goes_on && fibre == 0, notes);
            forget_laid(program.made);
        }
    }

    // What was laid has been judged; of a long fibre it takes as much memory as the plan.
    static void forget_laid(PieceProgram& made) {
        LaidPath& laid = made.verification.laid;
        LaidPath kept;
        kept.peeled_mm = laid.peeled_mm;
        kept.peeled_block = laid.peeled_block;
        kept.failure = std::move(laid.failure);
        kept.failed_block = laid.failed_block;
        laid = std::move(kept);
        made.exact = {};
    }

    void check_closure() {
        const Plan& plan = layer_.plan;
        const PieceProgram& made = layer_.programs.front().made;
        const std::span<const PathPoint> laid = made.verification.laid.path;
        if (plan.pattern() != nullptr && plan.pattern()->starts_rad.size() > 1) {
            layer_.checks.push_back(closure_check(plan, laid));
        }
        if (plan.elbow() != nullptr && plan.elbow()->lines > 1) {
            const LaidPath meant =
                lay_down(*setup_.wall, setup_.machine, made.exact, *made.exact.tie_on_mm);
            layer_.checks.push_back(
                elbow_closure_check(plan, setup_.job.tow.width_mm, laid, meant.path));
        }
    }

    void check_fibres() {
        Check check(check_kind::kContinuity, layer_.plan.fibres <= setup_.job.fibres);
        check.numbers = {{"fibres", static_cast<double>(layer_.plan.fibres)},
                         {"limit", static_cast<double>(setup_.job.fibres)},
                         {"worst_joint_mm", layer_.plan.worst_joint_mm}};
        if (!check.ok) {
            check.words =
                "the plan takes " + std::to_string(layer_.plan.fibres) +
                " separate fibres; a slimmer head, less clearance, a longer extension or more "
                "friction gives more courses to join them";
        }
        layer_.checks.push_back(check);
    }

    // Points too far off are refused before; how far they were tells of their mandrel.
    void check_import() {
        const ImportFit& fit = *layer_.import;
        Check check(check_kind::kImport);
        check.numbers = {{"worst_mm", fit.worst_mm},
                         {"mean_mm", fit.mean_mm},
                         {"limit_mm", fit.limit_mm},
                         {"worst_line", static_cast<double>(fit.worst_line)}};
        layer_.checks.push_back(check);
    }

    // ": 12.3 cm2 are bare, for ..." with the reason that keeps most wall bare.
    [[nodiscard]] std::string largest_bare_wall() const {
        std::map<std::string, double> area_mm2;
        for (const Uncovered& bare : layer_.plan.uncovered) {
            area_mm2[bare.rule] += bare.area_mm2;
        }
        const auto largest =
            std::max_element(area_mm2.begin(), area_mm2.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        return largest == area_mm2.end() ? ""
                                         : "; " + fixed(largest->second / 100.0, 2) +
                                               " cm2 are bare for this: " + largest->first;
    }

    [[nodiscard]] std::string those_joined() const {
        const std::optional<double>& joinable = layer_.plan.coverage.joinable;
        return joinable ? ", those that " + counted(layer_.setup.job.fibres, "fibre") +
                              " can join " + fixed(100.0 * *joinable, 1) + " %"
                        : std::string();
    }

    // On the face that misses the most.
    [[nodiscard]] CheckPlace barest_place() const {
        const Surface& surface = setup_.mandrel.surface;
        const std::vector<double>& layers = layer_.plan.face_layers;
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

    void check_coverage() {
        if (is_open(layer_.plan)) {
            layer_.checks.push_back(open_coverage_check(layer_.plan));
            return;
        }
        const Coverage& coverage = layer_.plan.coverage;
        const double limit = least_covered(coverage, layer_.setup.job.tolerance.bare);
        Check check(check_kind::kCoverage, coverage.fraction >= limit);
        check.numbers = {{"limit", limit}, {"fraction", coverage.fraction}};
        check.place = barest_place();
        if (!check.ok) {
            check.words = "only " + fixed(100.0 * coverage.fraction, 1) +
                          " % of the wall is covered although single courses reach " +
                          fixed(100.0 * coverage.reachable, 1) + " %" + those_joined() +
                          largest_bare_wall();
        }
        layer_.checks.push_back(check);
    }

    [[nodiscard]] std::vector<Check> checks_of(const PieceProgram& made) const {
        std::vector<Check> checks{eye_check(made), rounding_check(made)};
        const std::vector<Check>& found = made.verification.checks;
        checks.insert(checks.end(), found.begin(), found.end());
        return checks;
    }

    [[nodiscard]] Check eye_check(const PieceProgram& made) const {
        const std::vector<std::size_t>& blocked = made.eyes.blocked;
        Check check(check_kind::kEye, blocked.empty());
        check.numbers = {{"blocked_points", static_cast<double>(blocked.size())}};
        if (!check.ok) {
            check.words = made.eyes.words + " at " + place_of(made.eyes.path[blocked.front()]);
            check.place = {.position_mm = made.eyes.path[blocked.front()].landing_mm};
        }
        return check;
    }

    [[nodiscard]] static Check rounding_check(const PieceProgram& made) {
        Check check(check_kind::kRounding, made.read.nano == made.blocks.nano);
        check.numbers["blocks"] = static_cast<double>(made.read.moves());
        if (!check.ok) {
            check.words = "the program read back does not give the positions that were planned";
        }
        return check;
    }

    WoundLayer& layer_;
    const Setup& setup_;
    const WindLayerOptions& options_;
};

}  // namespace

double WoundLayer::duration_s() const {
    double sum_s = 0.0;
    for (const FibreProgram& program : programs) {
        sum_s += program.made.duration_s;
    }
    return sum_s;
}

void wind_layer(WoundLayer& layer, const WindLayerOptions& options) {
    LayerWinder(layer, options).run();
}

}  // namespace meshwind
