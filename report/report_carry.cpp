#include "report/report_carry.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "core/text/text_number.h"
#include "core/units.h"
#include "core/version.h"
#include "report/folder/run_files.h"
#include "report/report_checks.h"

namespace meshwind {
namespace {

using nlohmann::json;

const char* name_of(Singularity kind) {
    switch (kind) {
        case Singularity::Shoulder:
            return "shoulder";
        case Singularity::Elbow:
            return "elbow";
        case Singularity::Wrist:
            return "wrist";
        case Singularity::Other:
            break;
    }
    return "other";
}

// "D acceleration" as "A4 acceleration"; velocities count with the passage (time_moves).
std::string limit_name(const Machine& machine, const std::string& name) {
    if (name == "fibre") {
        return "passage and velocities";
    }
    return "A" + std::to_string(machine.joint_of(name.front()).value() + 1) + name.substr(1);
}

json winding_json(const CarryOutcome& outcome) {
    const CarryRequest& request = outcome.request;
    json rings = json::array();
    for (const RingResult& ring : outcome.ring) {
        rings.push_back(
            {{"laid_deg_at_even_speed",
              {{"min", report_number(ring.lowest_deg)}, {"max", report_number(ring.highest_deg)}}},
             {"rev_min_for_angle",
              {{"min", report_number(ring.slowest_rev_min)},
               {"max", report_number(ring.fastest_rev_min)}}}});
    }
    json winding = {
        {"angle_deg", request.angle_deg},
        {"tube_radius_mm", outcome.tube_radius_mm},
        {"tows_per_ring", request.tows},
        {"turns_per_mm", report_number(outcome.turns_per_mm)},
        {"mm_per_turn", outcome.turns_per_mm > 0.0 ? json(report_number(1.0 / outcome.turns_per_mm))
                                                   : json(nullptr)},
        {"rings", rings},
        {"longitudinal_lean_deg", report_number(outcome.longitudinal_deg)},
        {"coverage", nullptr}};
    if (request.tow_width_mm) {
        winding["coverage"] =
            report_number(ring_coverage(request.tows, *request.tow_width_mm,
                                        rad_from_deg(request.angle_deg), outcome.tube_radius_mm));
    }
    return winding;
}

json pattern_json(const CarryWinding& winding, const CarryRequest& request) {
    const RingPattern& pattern = winding.pattern;
    const auto degrees = [](double rad) { return report_number(deg_from_rad(rad)); };
    const bool bent = std::isfinite(winding.bend_radius_mm);
    json result = {
        {"ways", request.winding.at_once ? "at-once" : "to-and-fro"},
        {"passes", pattern.passes},
        {"offset_deg", degrees(pattern.offset_rad)},
        {"tow_width_mm", report_number(pattern.tow_width_mm)},
        {"tows_needed", report_number(pattern.tows_needed)},
        {"tows_needed_outside", report_number(pattern.tows_needed_outside)},
        {"layers_of_a_ring", report_number(pattern.coverage)},
        {"layers_of_a_ring_outside", report_number(pattern.coverage_outside)},
        {"bend_radius_mm", bent ? json(report_number(winding.bend_radius_mm)) : json(nullptr)},
        {"inside_deg", degrees(pattern.inside_rad)},
        {"outside_deg", degrees(pattern.outside_rad)},
        {"inside_over_outside", report_number(pattern.thickness_ratio)},
        {"bridging_below_deg", degrees(pattern.bridging_rad)},
        {"spool_radius_mm", report_number(winding.spool_radius_mm)},
        {"lag_mm", report_number(winding.lag_mm)},
        {"wound_from_mm", report_number(winding.zone_from_mm)},
        {"wound_to_mm", report_number(winding.zone_to_mm)},
        {"fibre_mm", report_number(pattern.fibre_mm)},
        {"fibre_per_tow_mm", report_number(pattern.fibre_per_tow_mm)},
        {"mass_kg", nullptr}};
    if (request.winding.tow_tex) {
        result["mass_kg"] =
            report_number(fibre_mass_kg(pattern.fibre_mm, *request.winding.tow_tex));
    }
    return result;
}

json laid_json(const CarryWinding& winding) {
    const auto degrees = [](double rad) { return report_number(deg_from_rad(rad)); };
    const RingCover& cover = winding.cover;
    const RingQuality& quality = winding.quality;
    json laid = {{"fibre_mm", report_number(winding.fibre_mm)},
                 {"covered", report_number(cover.covered)},
                 {"mean_layers", report_number(cover.mean_layers)},
                 {"regular_cv", report_number(cover.regular_cv)},
                 {"regular_mm", report_number(cover.regular_mm)},
                 {"friction_needed",
                  std::isfinite(quality.slip) ? json(report_number(quality.slip)) : json(nullptr)},
                 {"friction_needed_at_mm", report_number(quality.slip_s_mm)},
                 {"inside_over_outside", nullptr}};
    if (cover.outside_layers > 0.0) {
        laid["inside_over_outside"] = report_number(cover.inside_layers / cover.outside_layers);
        laid["bend_deg"] = {{"min", degrees(quality.outside_rad)},
                            {"max", degrees(quality.inside_rad)}};
    }
    return laid;
}

json axis_json(const CarryOutcome& outcome) {
    json axis = {{"file", outcome.axis.file},
                 {"sha256", outcome.axis.digest},
                 {"points", outcome.stations},
                 {"length_mm", report_number(outcome.length_mm)}};
    if (outcome.axis.frame_in_file) {
        const Eigen::Isometry3d& frame = *outcome.axis.frame_in_file;
        axis["frame_in_file"] = {{"origin_mm", report_vector(frame.translation())},
                                 {"x", report_vector(frame.linear().col(0))},
                                 {"z", report_vector(frame.linear().col(2))}};
        axis["residual_mm"] = report_number(outcome.axis.residual_mm);
    }
    return axis;
}

json axes_json(const CarryOutcome& outcome) {
    json axes = json::object();
    for (std::size_t a = 0; a < outcome.joints.path.axis_count; ++a) {
        double low = outcome.joints.path.row(0)[a];
        double high = low;
        for (std::size_t i = 1; i < outcome.joints.path.size(); ++i) {
            low = std::min(low, outcome.joints.path.row(i)[a]);
            high = std::max(high, outcome.joints.path.row(i)[a]);
        }
        axes["A" + std::to_string(a + 1)] = {{"min", report_number(deg_from_rad(low))},
                                             {"max", report_number(deg_from_rad(high))}};
    }
    return axes;
}

void print_winding(std::ostream& out, const CarryWinding& winding, int tows) {
    const RingPattern& pattern = winding.pattern;
    const RingCover& cover = winding.cover;
    out << "pattern: " << tows << " tows of " << fixed(pattern.tow_width_mm, 2) << " mm a ring in "
        << pattern.passes << (pattern.passes == 1 ? " pass, " : " passes, ")
        << fixed(1e-3 * winding.fibre_mm, 2) << " m of fibre from "
        << fixed(winding.zone_from_mm, 1) << " to " << fixed(winding.zone_to_mm, 1) << " mm\n"
        << "laid: " << fixed(100.0 * cover.covered, 2) << " % covered, layers scatter by "
        << fixed(cover.regular_cv, 4) << " on regular arms";
    if (cover.outside_layers > 0.0) {
        out << ", " << fixed(cover.inside_layers / cover.outside_layers, 3)
            << " times as thick inside the bend as outside";
    }
    out << "; needs a friction of " << fixed(winding.quality.slip, 3) << '\n';
}

}  // namespace

std::string carry_json(const CarryOutcome& outcome) {
    json binding = json::object();
    for (const BindingLimit& limit : outcome.planned.binding) {
        binding[limit_name(outcome.machine, limit.name)] = report_number(limit.time_s);
    }
    const CarriedJoints& joints = outcome.joints;
    const json report = {
        {"meshwind", kVersion},
        {"axis", axis_json(outcome)},
        {"machine", outcome.machine.name},
        {"head",
         {{"centre_mm", report_vector(outcome.head.centre_mm)},
          {"direction", report_vector(outcome.head.direction)},
          {"reference", report_vector(outcome.head.reference)},
          {"ring_distance_mm", outcome.head.ring_distance_mm},
          {"ring_radius_mm", outcome.head.ring_radius_mm}}},
        {"tool", outcome.request.tool},
        {"winding", winding_json(outcome)},
        {"pattern", outcome.winding ? pattern_json(*outcome.winding, outcome.request) : json()},
        {"laid", outcome.winding ? laid_json(*outcome.winding) : json()},
        {"robot",
         {{"singular",
           {{"least", report_number(joints.singular)},
            {"kind", name_of(joints.nearest)},
            {"s_mm", report_number(outcome.samples[joints.singular_at].s_mm)}}},
          {"axes_deg", axes_json(outcome)},
          {"time_set_by_s", binding}}},
        {"checks", checks_report(outcome.checks)},
        {"program",
         {{"file", outcome.usable ? json(outcome.request.name + kKrlExtension) : json(nullptr)},
          {"back_file", outcome.usable && outcome.winds_back()
                            ? json(carried_back(outcome.request.name) + kKrlExtension)
                            : json(nullptr)},
          {"dialect", kCarryDialect},
          {"moves", outcome.program.moves.size()},
          {"duration_s", report_number(outcome.total_s())}}},
        {"ok", outcome.passed()}};
    return json_text(report);
}

void print_carry(std::ostream& out, const CarryOutcome& outcome,
                 const std::filesystem::path& folder) {
    const RingResult& ring = outcome.ring.front();
    out << outcome.axis.file << " on " << outcome.machine.name << ": "
        << fixed(outcome.length_mm, 1) << " mm of axis in " << outcome.program.moves.size()
        << " moves, " << fixed(outcome.total_s(), 1) << " s\n"
        << "rings: " << fixed(outcome.turns_per_mm * outcome.request.speed_mm_s * 60.0, 2)
        << " rev/min each way lay " << fixed(ring.lowest_deg, 1) << " to "
        << fixed(ring.highest_deg, 1) << " and " << fixed(outcome.ring.back().lowest_deg, 1)
        << " to " << fixed(outcome.ring.back().highest_deg, 1)
        << " deg; motion.csv has the speeds that keep " << fixed(outcome.request.angle_deg, 1)
        << " deg\n";
    if (outcome.winding) {
        print_winding(out, *outcome.winding, outcome.request.tows);
    }
    print_checks(out, outcome.checks);
    std::string files =
        outcome.usable ? "written: " + outcome.request.name + kKrlExtension : "no program";
    if (outcome.winding) {
        if (outcome.usable && outcome.winds_back()) {
            files += ", " + carried_back(outcome.request.name) + kKrlExtension;
        }
        files += ", rings.csv, fibre.csv";
    }
    out << files << ", motion.csv and report.json in " << folder.string() << '\n';
}

void write_carry(const CarryOutcome& outcome, OutputFolder& folder) {
    folder.withdraw_earlier_run();
    const auto put = [&](const std::string& name, bool there, const std::string& text) {
        if (there) {
            folder.add(name, text);
        } else {
            folder.withdraw(name);
        }
    };
    const std::string& name = outcome.request.name;
    put(name + kKrlExtension, outcome.usable, outcome.text);
    put(carried_back(name) + kKrlExtension, outcome.usable && outcome.winds_back(),
        outcome.back_text);
    const bool wound = outcome.winding.has_value();
    put("rings.csv", wound, wound ? outcome.winding->rings : "");
    put("fibre.csv", wound, wound ? fibre_csv(outcome.winding->fibres) : "");
    folder.add("motion.csv", outcome.motion);
    folder.add("report.json", carry_json(outcome));
    folder.publish();
}

}  // namespace meshwind
