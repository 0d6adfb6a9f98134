#include "report/report_design.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "core/version.h"
#include "pipeline/job/job.h"
#include "report/report_checks.h"

namespace meshwind {
namespace {

using nlohmann::json;

// Places of a meridian in the report, ends included; evenly in the dome's parameter.
constexpr int kPlaces = 33;

double place(double end, int i) {
    return end * i / (kPlaces - 1);
}

json optional_number(const std::optional<double>& value) {
    return value ? json(report_number(*value)) : json(nullptr);
}

json vessel_json(const VesselDesign& design) {
    json vessel = {{"radius_mm", report_number(design.radius_mm)},
                   {"opening_radius_mm", report_number(design.opening_radius_mm)},
                   {"cylinder_length_mm", report_number(design.cylinder_length_mm)},
                   {"ke", report_number(design.stiffness_ratio)},
                   {"design_radius_mm", report_number(design.dome().design_radius_mm)},
                   {"band_mm", report_number(design.band_mm)},
                   {"thickness_mm", report_number(design.ply_mm)},
                   {"density_kg_m3", report_number(design.density_kg_m3)},
                   {"wall_mm", optional_number(design.wall_mm)},
                   {"pressure_mpa", optional_number(design.pressure_mpa)}};
    if (design.pressure_mpa) {
        vessel["strength_mpa"] = report_number(design.strength_mpa);
    }
    return vessel;
}

json dome_json(const DesignOutcome& outcome) {
    const IsotensoidDome& dome = outcome.dome;
    const double end = outcome.opening_parameter();
    json profile = json::array();
    for (int i = 0; i < kPlaces; ++i) {
        const double t = place(end, i);
        profile.push_back({{"radius_mm", report_number(dome.radius_mm(t))},
                           {"height_mm", report_number(dome.height_mm(t))}});
    }
    return {{"height_mm", report_number(dome.height_mm(end))},
            {"meridian_mm", report_number(dome.meridian_mm(end))},
            {"least_radius_mm", report_number(dome.least_radius_mm())},
            {"profile", profile}};
}

json thickness_json(const DesignOutcome& outcome, const VesselAngle& row) {
    const double inner =
        std::max({row.clairaut_mm - 0.5 * outcome.design.band_mm, outcome.dome.least_radius_mm(),
                  outcome.design.opening_radius_mm});
    const double end = outcome.dome.parameter_at(inner);
    json thickness = json::array();
    for (int i = 0; i < kPlaces; ++i) {
        const double radius = outcome.dome.radius_mm(place(end, i));
        thickness.push_back({{"radius_mm", report_number(radius)},
                             {"thickness_mm", report_number(thickness_on_dome_mm(
                                                  row.band(outcome.design), radius))}});
    }
    return thickness;
}

json row_json(const DesignOutcome& outcome, const VesselAngle& row) {
    json out = {{"angle_deg", report_number(deg_from_rad(row.angle_rad))},
                {"clairaut_radius_mm", report_number(row.clairaut_mm)},
                {"geodesic", row.pass.has_value()},
                {"cylinder_turn_deg", report_number(deg_from_rad(row.cylinder_turn_rad))},
                {"circuits", row.circuits},
                {"layers", report_number(row.layers)},
                {"wall_mm", report_number(row.layers * outcome.design.ply_mm)},
                {"hoop_layers", row.hoop_layers}};
    if (!row.pass) {
        out["slip_to_turn"] = optional_number(row.slip);
        return out;
    }
    out["dome_turn_deg"] = report_number(deg_from_rad(row.pass->turn_rad));
    out["dome_pass_mm"] = report_number(row.pass->length_mm);
    out["circuit_turn_deg"] = report_number(deg_from_rad(row.circuit_turn_rad));
    out["circuit_length_mm"] = report_number(row.circuit_length_mm);
    out["fibre_length_mm"] = report_number(row.fibre_length_mm);
    out["mass_kg"] = report_number(row.mass_kg);
    out["thickest_mm"] = report_number(row.thickest_mm);
    out["thickness"] = thickness_json(outcome, row);
    return out;
}

class Line {
public:
    Line& add(const std::string& text, std::size_t width) {
        text_ += std::string(width > text.size() ? width - text.size() : 1, ' ') + text;
        return *this;
    }
    Line& add(double value, int decimals, std::size_t width) {
        return add(fixed(value, decimals), width);
    }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::string text_;
};

constexpr std::size_t kAngle = 7;
constexpr std::size_t kWide = 12;
constexpr std::size_t kNarrow = 10;

void print_head(std::ostream& out, bool hoops) {
    Line names;
    names.add("angle", kAngle).add("Clairaut", kNarrow).add("dome turn", kNarrow);
    names.add("circuit", kWide).add("dome pass", kNarrow).add("circuits", kNarrow);
    names.add("layers", kNarrow).add("wall", kNarrow);
    Line units;
    units.add("deg", kAngle).add("mm", kNarrow).add("deg", kNarrow).add("deg", kWide);
    units.add("mm", kNarrow).add("", kNarrow).add("", kNarrow).add("mm", kNarrow);
    if (hoops) {
        names.add("hoops", kNarrow);
        units.add("layers", kNarrow);
    }
    names.add("fibre", kNarrow).add("mass", kNarrow).add("thickest", kNarrow);
    units.add("m", kNarrow).add("kg", kNarrow).add("mm", kNarrow);
    out << names.text() << '\n' << units.text() << '\n';
}

void print_row(std::ostream& out, const VesselDesign& design, const VesselAngle& row) {
    constexpr double kMetre = 1e-3;
    Line line;
    line.add(deg_from_rad(row.angle_rad), 2, kAngle).add(row.clairaut_mm, 2, kNarrow);
    if (row.pass) {
        line.add(deg_from_rad(row.pass->turn_rad), 2, kNarrow)
            .add(deg_from_rad(row.circuit_turn_rad), 2, kWide)
            .add(row.pass->length_mm, 2, kNarrow);
    } else {
        line.add("-", kNarrow).add("-", kWide).add("-", kNarrow);
    }
    line.add(std::to_string(row.circuits), kNarrow).add(row.layers, 2, kNarrow);
    line.add(row.layers * design.ply_mm, 3, kNarrow);
    if (design.pressure_mpa) {
        line.add(std::to_string(row.hoop_layers), kNarrow);
    }
    if (row.pass) {
        line.add(kMetre * row.fibre_length_mm, 1, kNarrow)
            .add(row.mass_kg, 3, kNarrow)
            .add(row.thickest_mm, 3, kNarrow);
    } else {
        line.add("-", kNarrow).add("-", kNarrow).add("-", kNarrow);
    }
    out << line.text() << '\n';
}

}  // namespace

std::string design_json(const DesignOutcome& outcome) {
    json report = {{"meshwind", kVersion},
                   {"vessel", vessel_json(outcome.design)},
                   {"dome", dome_json(outcome)},
                   {"angles", json::array()}};
    for (const VesselAngle& row : outcome.rows) {
        report["angles"].push_back(row_json(outcome, row));
    }
    return json_text(report);
}

void print_design(std::ostream& out, const DesignOutcome& outcome) {
    const VesselDesign& design = outcome.design;
    const double end = outcome.opening_parameter();
    out << "dome          ke " << fixed(design.stiffness_ratio, 5) << ", "
        << fixed(outcome.dome.height_mm(end), 3) << " mm high, meridian "
        << fixed(outcome.dome.meridian_mm(end), 3) << " mm, would turn back at a radius of "
        << fixed(outcome.dome.least_radius_mm(), 3) << " mm\n"
        << "geodesics     turn on it from "
        << fixed(deg_from_rad(std::asin(design.opening_radius_mm / design.radius_mm)), 2)
        << " deg on\n";
    print_head(out, design.pressure_mpa.has_value());
    for (const VesselAngle& row : outcome.rows) {
        print_row(out, design, row);
    }
    for (const VesselAngle& row : outcome.rows) {
        if (!row.pass) {
            out << fixed(deg_from_rad(row.angle_rad), 2) << " deg: no geodesic turns on the dome; "
                << (row.slip ? "a constant slip ratio of " + fixed(*row.slip, 3) +
                                   " would turn it at the opening\n"
                             : "no slip ratio up to 1 turns it there\n");
        }
    }
}

const VesselAngle& least_fibre(const DesignOutcome& outcome) {
    const VesselAngle* least = nullptr;
    for (const VesselAngle& row : outcome.rows) {
        if (row.pass && (least == nullptr || row.fibre_length_mm < least->fibre_length_mm)) {
            least = &row;
        }
    }
    if (least == nullptr) {
        throw InputError("vessel.no_geodesic", "--angles",
                         "no geodesic of these angles turns on the domes; they do from " +
                             fixed(deg_from_rad(std::asin(outcome.design.opening_radius_mm /
                                                          outcome.design.radius_mm)),
                                   2) +
                             " deg on");
    }
    return *least;
}

std::string design_job(const VesselDesign& design, const VesselAngle& angle) {
    constexpr double kKgPerM3 = 1000.0;  // of 1 g/cm3
    Job job;
    job.tow.width_mm = design.band_mm;
    job.tow.thickness_mm = design.ply_mm;
    job.tow.density_g_cm3 = design.density_kg_m3 / kKgPerM3;
    LayerJob& wound = job.layers.front();
    wound.kind = LayerKind::Helical;
    wound.angle_deg = deg_from_rad(angle.angle_rad);
    wound.target_layers = angle.layers;
    if (angle.hoop_layers > 0) {
        LayerJob& hoops = job.layers.emplace_back();
        hoops.kind = LayerKind::Hoop;
        hoops.target_layers = angle.hoop_layers;
    }
    return told_job_text(job) + "\n";
}

}  // namespace meshwind
