#include "report/report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/counted.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "core/version.h"
#include "pipeline/part_words.h"
#include "pipeline/run_names.h"
#include "report/report_checks.h"
#include "report/report_layers.h"
#include "report/report_mandrel.h"

namespace meshwind {
namespace {

using nlohmann::json;

json what_if_report(const Plan& plan) {
    json all = json::array();
    for (const RelaxedRule& what_if : plan.what_if) {
        all.push_back({{"rule", name_of(what_if.rule)},
                       {"factor", what_if.factor},
                       {"reachable", report_number(what_if.reachable)}});
    }
    return all;
}

json reach_report(const Plan& plan) {
    json shares = json::array();
    for (const double share : plan.reach_of_fibres) {
        shares.push_back(report_number(share));
    }
    return shares;
}

json pins_report(std::span<const PinRing> rings) {
    json report = json::array();
    for (const PinRing& ring : rings) {
        report.push_back({{"rim", ring.rim},
                          {"count", ring.count},
                          {"diameter_mm", report_number(ring.diameter_mm)},
                          {"height_mm", report_number(ring.height_mm)},
                          {"offset_mm", report_number(ring.offset_mm)},
                          {"azimuth_deg", report_number(deg_from_rad(ring.azimuth_rad))},
                          {"skip", ring.skip},
                          {"strand_mm", report_number(2.0 * ring.strand_mm)}});
    }
    return report;
}

json turns_report(const Plan& plan) {
    json rims = json::array();
    for (std::size_t rim = 0; rim < plan.turns.size(); ++rim) {
        rims.push_back({{"rim", rim},
                        {"turns", plan.turns[rim].turns},
                        {"extension_mm", report_number(plan.turns[rim].extension_mm)},
                        {"dwell_deg", report_number(deg_from_rad(plan.turns[rim].dwell_rad))}});
    }
    return rims;
}

json families_report(const Plan& plan) {
    const auto in_families = std::count_if(plan.family.begin(), plan.family.end(),
                                           [](std::int32_t family) { return family >= 0; });
    std::int32_t families = 0;
    for (const std::int32_t family : plan.family) {
        families = std::max(families, family + 1);
    }
    return {{"families", families}, {"courses", in_families}, {"per_course", plan.family}};
}

// Over pipes, degrees from the axial direction of each.
json angles_report(const Plan& plan) {
    json angles = {{"length_mm", report_number(plan.angle.measured_mm)},
                   {"mean_deg", report_number(deg_from_rad(plan.angle.mean_rad))}};
    if (plan.angle.wish_rad) {
        angles["wish_deg"] = report_number(deg_from_rad(*plan.angle.wish_rad));
        angles["rms_off_deg"] = report_number(deg_from_rad(plan.angle.rms_off_rad));
        angles["off_share"] = report_number(plan.angle.off_share);
    }
    return angles;
}

json pattern_report(const LaidPattern& laid) {
    const Pattern& pattern = laid.pattern;
    json report = {{"angle_deg", report_number(deg_from_rad(laid.angle_rad))},
                   {"slip_ratio", report_number(laid.slip_ratio)},
                   {"circuits", pattern.circuits},
                   {"turns", pattern.turns},
                   {"starts", pattern.starts},
                   {"skip", pattern.skip},
                   {"order", word_of(pattern.order)},
                   {"circuit_turn_deg", report_number(deg_from_rad(pattern.turn_rad))},
                   {"dwell_deg", report_number(deg_from_rad(pattern.dwell_rad))},
                   {"overlap", report_number(pattern.overlap)},
                   {"closure_deg", report_number(deg_from_rad(laid.closure_rad))},
                   {"band_offset_mm", report_number(laid.band_offset_mm)},
                   {"interlacing",
                    {{"crossing_rows", laid.interlacing.crossing_rows},
                     {"crossings", laid.interlacing.crossings},
                     {"diamonds_around", laid.interlacing.diamonds_around}}}};
    if (laid.lattice) {
        const LaidLattice& lattice = *laid.lattice;
        report["lattice"] = {{"ribs", 2 * pattern.circuits},
                             {"series", lattice.series},
                             {"plies", lattice.plies},
                             {"circuits_in_all", laid.starts_rad.size()},
                             {"offset_mm", report_number(lattice.offset_mm)},
                             {"rib_mm", report_number(lattice.rib_mm)},
                             {"rib_spacing_mm", report_number(lattice.rib_spacing_mm)},
                             {"filled", lattice.filled}};
    }
    return report;
}

json elbow_report(const LaidElbow& laid) {
    json legs = json::array();
    for (const LaidElbowLeg& leg : laid.leg) {
        legs.push_back({{"length_mm", report_number(leg.length_mm)},
                        {"run_mm", report_number(leg.run_mm)},
                        {"angle_deg", report_number(deg_from_rad(leg.angle_rad))},
                        {"even", report_number(leg.even)},
                        {"slip_ratio", report_number(leg.slip_ratio)},
                        {"widest_mm", report_number(leg.widest_mm)},
                        {"closed_mm", report_number(leg.closed_mm)}});
    }
    return {{"lines", laid.lines},
            {"needed_by_bend", laid.needed_by_bend},
            {"angle_deg", report_number(deg_from_rad(laid.angle_rad))},
            {"inner_angle_deg", report_number(deg_from_rad(laid.inner_angle_rad))},
            {"theta_cycle_deg", report_number(deg_from_rad(laid.theta_cycle_rad))},
            {"thinnest_layers", report_number(laid.thinnest_layers)},
            {"thickest_layers", report_number(laid.thickest_layers)},
            {"legs", legs}};
}

json uncovered_report(const Plan& plan) {
    json uncovered = json::array();
    for (const Uncovered& u : plan.uncovered) {
        uncovered.push_back(
            {{"region", u.region}, {"area_mm2", report_number(u.area_mm2)}, {"reason", u.reason}});
    }
    return uncovered;
}

json plan_coverage_report(const Coverage& coverage) {
    json report = {{"fraction", report_number(coverage.fraction)},
                   {"reachable", report_number(coverage.reachable)},
                   {"mean_layers", report_number(coverage.mean_layers)},
                   {"max_layers", coverage.max_layers},
                   {"p1_layers", coverage.p1_layers},
                   {"cv", report_number(coverage.cv)}};
    if (coverage.joinable) {
        report["joinable"] = report_number(*coverage.joinable);
    }
    if (coverage.regular_cv) {
        report["regular_cv"] = report_number(*coverage.regular_cv);
    }
    if (coverage.thinnest_layers && coverage.thickest_layers) {
        report["thinnest_layers"] = report_number(*coverage.thinnest_layers);
        report["thickest_layers"] = report_number(*coverage.thickest_layers);
    }
    return report;
}

// Candidates and courses that did not come into the plan, by their reasons.
json library_report(const PlanEffort& effort) {
    json refusals = json::object();
    for (std::size_t r = 0; r < kCandidateFaults; ++r) {
        refusals[name_of(static_cast<CandidateFault>(r))] = effort.refusals[r];
    }
    json rejections = json::object();
    for (std::size_t r = 1; r < kRejections; ++r) {
        rejections[name_of(static_cast<CourseFault>(r))] = effort.rejections[r];
    }
    return {{"candidates", effort.candidates},
            {"outcomes", refusals},
            {"rejected_courses", effort.rejected_courses},
            {"rejections", rejections}};
}

json plan_report(const Plan& plan) {
    json report = {
        {"planner", name_of(plan.planner)},
        {"courses", plan.courses},
        {"transitions", std::max(0, static_cast<int>(plan.pieces.size()) - plan.courses)},
        {"fibres", plan.fibres},
        {"reach_of_fibres", reach_report(plan)},
        {"fibre_length_mm", report_number(plan.fibre_length_mm)},
        {"coverage", plan_coverage_report(plan.coverage)},
        {"uncovered", uncovered_report(plan)},
        {"what_if", what_if_report(plan)},
        {"annealing",
         {{"seed", plan.effort.seed},
          {"effort", plan.effort.effort},
          {"proposals", plan.effort.proposals},
          {"taken", plan.effort.taken}}},
        {"angles", angles_report(plan)},
        {"turns", turns_report(plan)},
        {"families", families_report(plan)},
        {"order",
         {{"junctions_at", report_number(plan.places.junction)},
          {"hoops_at", report_number(plan.places.hoop)}}},
        {"library", library_report(plan.effort)}};
    if (plan.pattern() != nullptr) {
        report["pattern"] = pattern_report(*plan.pattern());
    }
    if (!plan.pins.empty()) {
        report["pins"] = pins_report(plan.pins);
    }
    if (plan.elbow() != nullptr) {
        report["elbow"] = elbow_report(*plan.elbow());
    }
    if (!plan.failure.empty()) {
        report["failure"] = plan.failure;
    }
    return report;
}

// Furthest of an axis from its planned position for circuits that are repeated, mm or deg.
double drift_of(const PieceProgram& made, std::size_t axis) {
    const std::vector<std::int64_t>& nano = made.layout.drift_nano;
    return nano.empty() ? 0.0 : static_cast<double>(nano[axis]) / static_cast<double>(kNanoPerUnit);
}

json repeats_report(const PieceProgram& made) {
    json drift = json::object();
    for (std::size_t a = 0; a < made.blocks.axes.size(); ++a) {
        drift[std::string(1, made.blocks.axes[a].letter)] = report_number(drift_of(made, a));
    }
    return {{"subprograms", made.layout.subprograms.size()},
            {"calls", made.layout.calls()},
            {"drift", drift}};
}

json axes_report(const PieceProgram& made) {
    json axes = json::object();
    const BlockList& list = made.blocks;
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        double low = list.value(0, a);
        double high = low;
        for (std::size_t b = 1; b < list.blocks.size(); ++b) {
            low = std::min(low, list.value(b, a));
            high = std::max(high, list.value(b, a));
        }
        const double step =
            static_cast<double>(list.axes[a].resolution_nano) / static_cast<double>(kNanoPerUnit);
        axes[std::string(1, list.axes[a].letter)] = {
            {"unit", list.axes[a].type == AxisType::Rotary ? "deg" : "mm"},
            {"min", report_number(low)},
            {"max", report_number(high)},
            {"resolution", step},
            {"max_rounding_error", 0.5 * step + drift_of(made, a)}};
    }
    return axes;
}

json choice_report(const BlockChoice& choice) {
    return {{"worst_sideways_mm", report_number(choice.worst_sideways_mm)},
            {"worst_angle_deg", report_number(deg_from_rad(choice.worst_angle_rad))},
            {"worst_pull_mm", report_number(choice.worst_pull_mm)},
            {"worst_eye_mm", report_number(choice.worst_eye_mm)},
            {"worst_twist_deg", report_number(deg_from_rad(choice.worst_twist_rad))},
            {"steps_beyond", choice.beyond}};
}

json refused_report(const PieceProgram& made) {
    json refused = json::array();
    for (const auto& [piece, reason] : made.refused) {
        refused.push_back({{"course", piece}, {"reason", name_of(reason)}});
    }
    return refused;
}

json program_report(const WoundLayer& layer, const FibreProgram& program, bool written) {
    const PieceProgram& made = program.made;
    json binding = json::array();
    for (const BindingLimit& limit : made.binding) {
        json longest = json::array();
        for (const BindingStretch& stretch : limit.stretches) {
            longest.push_back({{"first_block", stretch.first},
                               {"last_block", stretch.last},
                               {"time_s", report_number(stretch.time_s)}});
        }
        binding.push_back(
            {{"limit", limit.name}, {"time_s", report_number(limit.time_s)}, {"longest", longest}});
    }
    return {{"file", written ? json(program.file) : json(nullptr)},
            {"dialect", layer.setup.machine.controller.dialect},
            {"path_points", made.path_points},
            {"blocks", made.blocks.moves()},
            {"choice", choice_report(made.choice)},
            {"optimal_motion", made.optimal},
            {"duration_s", report_number(made.duration_s)},
            {"corner_s", report_number(made.corner_s)},
            {"least_s", report_number(made.least_s)},
            {"free_length_mm",
             {{"min", report_number(made.eyes.shortest_mm)},
              {"max", report_number(made.eyes.longest_mm)}}},
            {"binding_limits", binding},
            {"refused", refused_report(made)},
            {"repeats", repeats_report(made)},
            {"axes", axes_report(made)}};
}

json import_report(const ImportFit& fit) {
    return {{"file", fit.file},
            {"frame", fit.mandrel_frame ? "mandrel" : "file"},
            {"points", fit.points},
            {"repeated_points", fit.repeated},
            {"joins", fit.joins},
            {"worst_mm", report_number(fit.worst_mm)},
            {"worst_line", fit.worst_line},
            {"mean_mm", report_number(fit.mean_mm)},
            {"limit_mm", report_number(fit.limit_mm)},
            {"circuits", fit.circuits},
            {"smoothed_mm", report_number(fit.smoothed_mm)}};
}

// What a layer is and what came of it.
void add_layer_report(json& report, const WoundLayer& layer, bool written) {
    report["plan"] = plan_report(layer.plan);
    const FibreUse use = use_of_fibre(layer);
    if (layer.job.kind != LayerKind::Wall) {  // whose stages count together
        report["plan"]["fibre_factor"] = report_number(use.factor);
        const double least_mm = layer.plan.least_fibre_mm.value_or(0.0);
        if (least_mm > 0.0 && layer.plan.fibre_length_mm > 0.0) {
            report["plan"]["bound"] =
                bound_report(use.factor * least_mm / layer.plan.fibre_length_mm, use.factor);
        }
    }
    report["plan"]["turn_share"] = report_number(use.turn_share);
    if (!layer.no_pattern.empty()) {
        report["plan"]["no_pattern"] = layer.no_pattern;
    }
    if (layer.job.angle_deg) {
        report["plan"]["asked_angle_deg"] = *layer.job.angle_deg;
    }
    if (layer.import) {
        report["import"] = import_report(*layer.import);
    }
    for (std::size_t fibre = 0; fibre < layer.programs.size(); ++fibre) {
        const FibreProgram& program = layer.programs[fibre];
        report["program" + fibre_suffix(fibre)] = program_report(layer, program, written);
        report["verification" + fibre_suffix(fibre)] =
            verification_report(program.made.verification, program.made.blocks);
    }
}

json eye_report(const Setup& setup) {
    json report = {{"rule", name_of(setup.job.eye.rule)}, {"by_machine", setup.rule_of_machine}};
    if (setup.job.eye.rule == EyeRule::Cylinder) {
        report["radius_mm"] = setup.job.eye.radius_mm;
    }
    return report;
}

}  // namespace

json report_of(const Run& run, const std::map<std::string, double>& timing_s) {
    const WoundLayer& first = run.layers.front();
    json report = {{"meshwind", kVersion},
                   {"machine", first.setup.machine.name},
                   {"mandrel", mandrel_report(first.setup.mandrel)},
                   {"checks", checks_report(run.checks)},
                   {"ok", run.passed()},
                   {"eye", eye_report(first.setup)},
                   {"run",
                    {{"job", json::parse(run.job)},
                     {"seed", run.seed},
                     {"effort", report_number(run.effort)}}},
                   {"remarks", run.remarks},
                   {"timing_s", timing_s}};
    if (!run.walls.empty()) {
        add_walls_report(report, run);
    }
    add_cost_report(report, run);
    if (run.layers.size() == 1) {
        add_layer_report(report, first, run.usable);
    } else {
        add_laminate_report(report, run);
        for (std::size_t i = 0; i < run.layers.size(); ++i) {
            add_layer_report(report["layers"][i], run.layers[i], run.usable);
        }
    }
    return report;
}

std::string report_text(const Run& run) {
    return json_text(report_of(run, run.timing_s));
}

}  // namespace meshwind
