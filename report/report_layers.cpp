#include "report/report_layers.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <string>

#include <nlohmann/json.hpp>

#include "core/counted.h"
#include "core/text/text_number.h"
#include "core/units.h"
#include "mesh/triangle_soup.h"
#include "pipeline/run_names.h"
#include "report/report_checks.h"
#include "winding/laminate/coverage.h"

namespace meshwind {
namespace {

using nlohmann::json;

constexpr double kMmPerM = 1000.0;
constexpr double kMm3PerCm3 = 1000.0;
constexpr double kGPerKg = 1000.0;

// The layers of all plans per face of the first surface, whose triangles the others keep.
std::vector<double> all_layers(const Run& run) {
    std::vector<double> sum(run.layers.front().setup.mandrel.surface.face.size(), 0.0);
    for (const WoundLayer& layer : run.layers) {
        for (std::size_t f = 0; f < layer.plan.face_layers.size(); ++f) {
            sum[f] += layer.plan.face_layers[f];
        }
    }
    return sum;
}

json coverage_report(const Run& run) {
    const Surface& surface = run.layers.front().setup.mandrel.surface;
    const std::vector<double> layers = all_layers(run);
    double area = 0.0;
    double covered = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    double most = 0.0;
    for (std::size_t f = 0; f < layers.size(); ++f) {
        const double face = area_mm2(surface.position_mm, surface.face[f]);
        area += face;
        covered += face * std::min(1.0, layers[f]);
        sum += face * layers[f];
        squares += face * layers[f] * layers[f];
        most = std::max(most, layers[f]);
    }
    const double mean = sum / area;
    const double variance = std::max(0.0, squares / area - mean * mean);
    return {{"fraction", report_number(covered / area)},
            {"mean_layers", report_number(mean)},
            {"max_layers", report_number(most)},
            {"cv", report_number(mean > 0.0 ? std::sqrt(variance) / mean : 0.0)}};
}

json figures_report(const LayerFigures& figures) {
    return {{"angle_deg", report_number(deg_from_rad(figures.angle_rad))},
            {"thickness_mm",
             {{"mean", report_number(figures.mean_thickness_mm)},
              {"max", report_number(figures.most_thickness_mm)}}},
            {"fibre_m", report_number(figures.fibre_m)},
            {"mass_g", report_number(figures.mass_g)},
            {"time_s", report_number(figures.time_s)}};
}

json wall_report(const WoundWall& wall) {
    const WallFigures& figures = wall.figures;
    json thin = json::array();
    for (const ThinRegion& region : figures.thin) {
        const Eigen::Vector3d& at = region.at_mm;
        thin.push_back({{"region", region.region},
                        {"below", report_number(region.below_share)},
                        {"lacks_mm", report_number(region.most_lacking_mm)},
                        {"position_mm",
                         {report_number(at.x()), report_number(at.y()), report_number(at.z())}}});
    }
    json report = {{"first_layer", wall.first + 1},
                   {"last_layer", wall.last + 1},
                   {"stages", figures.stages},
                   {"asked_layers", report_number(figures.asked_layers)},
                   {"reachable", report_number(figures.reachable)},
                   {"below", report_number(figures.below_share)},
                   {"mean_over_asked", report_number(figures.mean_ratio)},
                   {"p1_over_asked", report_number(figures.p1_ratio)},
                   {"cv", report_number(figures.cv)},
                   {"fibre_m", report_number(figures.fibre_mm / kMmPerM)},
                   {"turn_share", report_number(figures.turn_share)},
                   {"fibre_factor", report_number(figures.fibre_factor)},
                   {"thin", thin}};
    if (figures.least_factor > 0.0) {
        report["bound"] = bound_report(figures.least_factor, figures.fibre_factor);
    }
    return report;
}

void print_row(std::ostream& out, const std::string& name, const std::string& angle,
               const LayerFigures& figures) {
    out << "  " << std::left << std::setw(22) << name << std::right << std::setw(10) << angle
        << std::setw(12) << fixed(figures.mean_thickness_mm, 3) << std::setw(10)
        << fixed(figures.most_thickness_mm, 3) << std::setw(11) << fixed(figures.fibre_m, 1)
        << std::setw(10) << fixed(figures.mass_g, 1) << std::setw(9)
        << fixed(figures.time_s / 60.0, 1) << '\n';
}

}  // namespace

namespace {

// As the wall grows by the layer.
void add_build_up(const WoundLayer& layer, LayerFigures& figures) {
    const Surface& surface = layer.setup.mandrel.surface;
    double area = 0.0;
    for (const auto& face : surface.face) {
        const double third = area_mm2(surface.position_mm, face) / 3.0;
        for (const std::int32_t v : face) {
            area += third;
            figures.mean_thickness_mm += third * layer.build_up_mm[static_cast<std::size_t>(v)];
        }
    }
    figures.mean_thickness_mm /= area;
    figures.most_thickness_mm =
        *std::max_element(layer.build_up_mm.begin(), layer.build_up_mm.end());
}

// Of a single layer, on which nothing is wound: as much tow as lies on each triangle.
void add_tow(const WoundLayer& layer, LayerFigures& figures) {
    const Surface& surface = layer.setup.mandrel.surface;
    double area = 0.0;
    for (std::size_t f = 0; f < layer.plan.face_layers.size(); ++f) {
        const double face_mm2 = area_mm2(surface.position_mm, surface.face[f]);
        const double thickness_mm = layer.plan.face_layers[f] * layer.setup.job.tow.thickness_mm;
        area += face_mm2;
        figures.mean_thickness_mm += face_mm2 * thickness_mm;
        figures.most_thickness_mm = std::max(figures.most_thickness_mm, thickness_mm);
    }
    figures.mean_thickness_mm /= area > 0.0 ? area : 1.0;
}

}  // namespace

LayerFigures figures_of(const WoundLayer& layer) {
    const Plan& plan = layer.plan;
    const Job::TowJob& tow = layer.setup.job.tow;
    LayerFigures figures;
    figures.angle_rad = plan.pattern() != nullptr ? plan.pattern()->angle_rad : plan.angle.mean_rad;
    if (layer.build_up_mm.empty()) {
        add_tow(layer, figures);
    } else {
        add_build_up(layer, figures);
    }
    figures.fibre_m = plan.fibre_length_mm / kMmPerM;
    figures.mass_g =
        plan.fibre_length_mm * tow.width_mm * tow.thickness_mm / kMm3PerCm3 * tow.density_g_cm3;
    figures.scrap_m = use_of_fibre(layer).turn_share * figures.fibre_m;
    figures.time_s = layer.duration_s();
    return figures;
}

LayerFigures figures_of_all(const Run& run) {
    LayerFigures all;
    std::vector<double> thickness(run.layers.front().setup.mandrel.surface.position_mm.size());
    for (const WoundLayer& layer : run.layers) {
        const LayerFigures figures = figures_of(layer);
        all.mean_thickness_mm += figures.mean_thickness_mm;
        all.most_thickness_mm = std::max(all.most_thickness_mm, figures.most_thickness_mm);
        all.fibre_m += figures.fibre_m;
        all.mass_g += figures.mass_g;
        all.scrap_m += figures.scrap_m;
        all.time_s += figures.time_s;
        for (std::size_t v = 0; v < layer.build_up_mm.size(); ++v) {
            thickness[v] += layer.build_up_mm[v];
        }
    }
    for (const double vertex_mm : thickness) {
        all.most_thickness_mm = std::max(all.most_thickness_mm, vertex_mm);
    }
    if (const auto& price_per_kg = run.layers.front().setup.job.tow.price_per_kg) {
        all.price = *price_per_kg * all.mass_g / kGPerKg;
    }
    return all;
}

double least_fibre_m(const Run& run) {
    double least_m = 0.0;
    for (const WoundWall& wall : run.walls) {
        const WallFigures& figures = wall.figures;
        if (!(figures.least_factor > 0.0)) {
            return 0.0;
        }
        least_m += figures.fibre_mm / kMmPerM * figures.least_factor / figures.fibre_factor;
    }
    for (const WoundLayer& layer : run.layers) {
        if (layer.job.kind == LayerKind::Wall) {
            continue;
        }
        const double layer_m = layer.plan.least_fibre_mm.value_or(0.0) / kMmPerM;
        if (!(layer_m > 0.0)) {
            return 0.0;
        }
        least_m += layer_m;
    }
    return least_m;
}

FibreUse use_of_fibre(const WoundLayer& layer) {
    const Surface& surface = layer.setup.mandrel.surface;
    return fibre_use(layer.plan, layer.setup.job.tow.width_mm,
                     area_mm2({surface.position_mm, surface.face}), layer.job.target_layers);
}

const char* name_of(RelaxedRule::Rule rule) {
    switch (rule) {
        case RelaxedRule::Rule::Friction:
            return "friction";
        case RelaxedRule::Rule::Bridging:
            return "bridging tolerance";
        case RelaxedRule::Rule::Extension:
            return "extension";
        case RelaxedRule::Rule::Pins:
            return "pins";
    }
    return "";
}

const char* word_of(BandOrder order) {
    return order == BandOrder::Leading ? "leading" : "lagging";
}

void add_cost_report(json& report, const Run& run) {
    const LayerFigures all = figures_of_all(run);
    report["cost"] = {{"fibre_m", report_number(all.fibre_m)},
                      {"mass_g", report_number(all.mass_g)},
                      {"scrap_m", report_number(all.scrap_m)},
                      {"time_s", report_number(all.time_s)}};
    if (all.price) {
        report["cost"]["price"] = report_number(*all.price);
    }
    if (const double least_m = least_fibre_m(run); least_m > 0.0) {
        report["cost"]["least_fibre_m"] = report_number(least_m);
    }
}

json bound_report(double least_factor, double factor) {
    return {{"least_factor", report_number(least_factor)},
            {"gap", report_number(factor / least_factor - 1.0)}};
}

void add_walls_report(json& report, const Run& run) {
    json walls = json::array();
    for (const WoundWall& wall : run.walls) {
        walls.push_back(wall_report(wall));
    }
    report["walls"] = std::move(walls);
}

void print_walls(std::ostream& out, const Run& run) {
    for (const WoundWall& wall : run.walls) {
        const WallFigures& figures = wall.figures;
        if (figures.stages == 0) {
            continue;
        }
        out << "wall of " << fixed(figures.asked_layers, 1) << " layers in "
            << counted(figures.stages, "stage") << ": " << fixed(figures.mean_ratio, 2)
            << " times that on average, " << percent(figures.below_share, 2)
            << " of what is reachable is thinner, " << fixed(figures.p1_ratio, 2)
            << " times that or more on 99 % of it\n"
            << "  fibre factor " << fixed(figures.fibre_factor, 2)
            << " (1 would be the layers asked for without gaps, overlaps and turns)";
        if (figures.least_factor > 0.0) {
            out << "; no plan of single courses takes less than " << fixed(figures.least_factor, 2);
        }
        out << '\n';
    }
}

void add_laminate_report(json& report, const Run& run) {
    int courses = 0;
    std::size_t transitions = 0;
    int fibres = 0;
    std::size_t blocks = 0;
    json files = json::array();
    json layers = json::array();
    for (std::size_t i = 0; i < run.layers.size(); ++i) {
        const WoundLayer& layer = run.layers[i];
        courses += layer.plan.courses;
        transitions += layer.plan.pieces.size() - static_cast<std::size_t>(layer.plan.courses);
        fibres += layer.plan.fibres - (layer.plan.continues_fibre ? 1 : 0);
        for (const FibreProgram& program : layer.programs) {
            blocks += program.made.blocks.moves();
            files.push_back(program.file);
        }
        json row = {{"layer", i + 1},
                    {"kind", name_of(layer.job.kind)},
                    {"mandrel", i == 0 ? layer.setup.mandrel.file : grown_mandrel_name(i)},
                    {"goes_on", layer.plan.continues_fibre}};
        if (!layer.plan.cut_reason.empty()) {
            row["cut_because"] = layer.plan.cut_reason;
        }
        row.update(figures_report(figures_of(layer)));
        layers.push_back(std::move(row));
    }
    const LayerFigures all = figures_of_all(run);
    report["layers"] = layers;
    report["laminate"] = figures_report(all);
    report["laminate"].erase("angle_deg");
    report["plan"] = {{"planner", "layers"},
                      {"courses", courses},
                      {"transitions", transitions},
                      {"fibres", fibres},
                      {"fibre_length_mm", report_number(all.fibre_m * kMmPerM)},
                      {"coverage", coverage_report(run)},
                      {"uncovered", json::array()}};
    report["program"] = {{"file", run.usable ? files.front() : json(nullptr)},
                         {"files", run.usable ? files : json::array()},
                         {"dialect", run.layers.front().setup.machine.controller.dialect},
                         {"blocks", blocks},
                         {"duration_s", report_number(all.time_s)}};
}

void print_laminate(std::ostream& out, const Run& run) {
    out << "  layer                      angle  thickness       max      fibre      mass     time\n"
           "                               deg    mm mean        mm          m         g      "
           "min\n";
    for (std::size_t i = 0; i < run.layers.size(); ++i) {
        const WoundLayer& layer = run.layers[i];
        const LayerFigures figures = figures_of(layer);
        print_row(out, std::to_string(i + 1) + " " + std::string(name_of(layer.job.kind)),
                  fixed(deg_from_rad(figures.angle_rad), 2), figures);
    }
    print_row(out, "all", "", figures_of_all(run));
    for (std::size_t i = 1; i < run.layers.size(); ++i) {
        const std::string& why = run.layers[i].plan.cut_reason;
        if (!why.empty()) {
            out << "  layer " << i + 1 << " begins with a new fibre: " << why << '\n';
        }
    }
}

}  // namespace meshwind
