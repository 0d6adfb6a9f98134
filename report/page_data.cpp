#include "report/page_data.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "report/page/page_arrays.h"
#include "report/page/page_fibre.h"
#include "report/page/page_machine.h"
#include "report/report_checks.h"

namespace meshwind {
namespace {

using nlohmann::json;

void add_mandrel(const Mandrel& mandrel, PageArrays& arrays) {
    arrays.add_points("mandrel/points", mandrel.surface.position_mm);
    arrays.add_faces("mandrel/faces", mandrel.surface.face);
    arrays.add<std::int32_t>("mandrel/region", 1, mandrel.surface.region);
}

void add_layup(const std::string& prefix, const LayupArrays& layup, PageArrays& arrays) {
    arrays.add_floats(prefix + "layers", layup.layers);
    arrays.add_floats(prefix + "thickness_mm", layup.thickness_mm);
    arrays.add_floats(prefix + "angle_deg", layup.winding_deg);
}

void add_walls(const WallArrays& walls, PageArrays& arrays) {
    if (!walls.asked_layers.empty()) {
        arrays.add_floats("wall/asked_layers", walls.asked_layers);
        arrays.add_floats("wall/laid_layers", walls.laid_layers);
    }
}

std::size_t course_count(std::span<const Piece> pieces) {
    return static_cast<std::size_t>(
        std::count_if(pieces.begin(), pieces.end(),
                      [](const Piece& piece) { return piece.kind == PieceKind::Course; }));
}

json fibres_json(const WoundLayer& layer, const std::string& name, const PageExtent& extent,
                 PageArrays& arrays) {
    json report = json::array();
    const auto fibres = fibres_of(layer.plan.pieces);
    std::size_t course = 0;
    for (std::size_t fibre = 0; fibre < fibres.size(); ++fibre) {
        const ShownFibre shown{.layer = layer,
                               .pieces = fibres[fibre],
                               .program = layer.programs[fibre],
                               .first_course = course,
                               .prefix = name + "/fibre" + std::to_string(fibre + 1) + "/"};
        report.push_back(page_fibre(shown, extent, arrays));
        course += course_count(fibres[fibre]);
    }
    return report;
}

// \param number of the layer, from 0
json layer_json(const WoundLayer& layer, std::size_t number, const LayupArrays& layup,
                const PageExtent& extent, PageArrays& arrays) {
    const std::string name = "layer" + std::to_string(number + 1);
    json report = {{"name", "layer " + std::to_string(number + 1)},
                   {"kind", name_of(layer.job.kind)},
                   {"points", "mandrel/points"}};
    if (number > 0) {
        report["points"] = name + "/points";
        arrays.add_points(name + "/points", layer.setup.mandrel.surface.position_mm);
    }
    add_layup(name + "/", layup, arrays);
    report["fibres"] = fibres_json(layer, name, extent, arrays);
    return report;
}

json layers_json(const Run& run, const Layup& layup, PageArrays& arrays) {
    const PageExtent extent = page_extent(run);
    json layers = json::array();
    for (std::size_t i = 0; i < run.layers.size(); ++i) {
        layers.push_back(layer_json(run.layers[i], i, layup.each()[i], extent, arrays));
    }
    return layers;
}

json tow_json(const Setup& setup) {
    const Job::TowJob& tow = setup.job.tow;
    return {{"width_mm", tow.width_mm},
            {"thickness_mm", tow.thickness_mm},
            {"friction", setup.friction.holds()}};
}

}  // namespace

std::string page_data(const Run& run, const Layup& layup, json report) {
    const Setup& first = run.layers.front().setup;
    PageArrays arrays;
    add_mandrel(first.mandrel, arrays);
    add_layup("total/", layup.all(), arrays);
    add_walls(layup.walls(), arrays);
    json layers = layers_json(run, layup, arrays);
    json machine = page_machine(first.machine, arrays);
    json extension = page_extension(first, arrays);
    report.erase("timing_s");  // the same run writes the same page
    json header = {{"format", "meshwind-page-1"},
                   {"report", std::move(report)},
                   {"check_kinds", check_kinds_report(run.checks)},
                   {"machine", std::move(machine)},
                   {"tow", tow_json(first)},
                   {"extension", std::move(extension)},
                   {"layers", std::move(layers)}};
    return arrays.behind(std::move(header));
}

}  // namespace meshwind
