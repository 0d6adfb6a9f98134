#include "report/layup_files.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "core/text/text_number.h"
#include "core/units.h"
#include "core/version.h"
#include "pipeline/run_names.h"
#include "postproc/tables/fibre_lines.h"
#include "report/layup_vtu.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// What the numbers of layup.json are rounded to: far below the tolerances of a winding.
constexpr double kPlaces_per_mm = 1e6;     // lengths, areas, thicknesses
constexpr double kParts_per_unit = 1e7;    // unit vectors
constexpr double kParts_per_degree = 1e3;  // angles
constexpr double kParts_per_layer = 1e6;   // numbers of layers

// Plies whose directions layup.vtu has: on most of a wall more than lie there, and each is an
// array.
constexpr std::size_t kMaxDirections = 12;

// \param of "" for all layers, "_of_layer_2" for one
void add_cells(const LayupArrays& arrays, const std::string& of, std::vector<CellArray>& cells) {
    const auto add = [&](const std::string& quantity, const char* unit, const auto& values) {
        cells.push_back({quantity + of + unit, std::span(values)});
    };
    add("layers", "", arrays.layers);
    add("thickness", "_mm", arrays.thickness_mm);
    add("fibre_angle_to_spindle", "_deg", arrays.spindle_deg);
    add("winding_angle", "_deg", arrays.winding_deg);
    add("area", "_mm2", arrays.area_mm2);
    add("covered_share", "", arrays.covered);
    if (!arrays.samples.empty()) {
        add("samples", "", arrays.samples);
    }
}

class LayupWriter {
public:
    LayupWriter(const Run& run, const Layup& layup)
        : run_(run),
          layup_(layup),
          surface_(run.layers.front().setup.mandrel.surface),
          tow_(run.layers.front().setup.job.tow) {}

    [[nodiscard]] std::string vtu() const {
        std::vector<CellArray> cells;
        add_cells(layup_.all(), "", cells);
        cells.push_back({"region", std::span<const std::int32_t>(surface_.region)});
        cells.push_back({"axis_1", std::span<const Vector3d>(layup_.axes())});
        const std::vector<std::vector<Vector3d>> directions = directions_of_plies();
        for (std::size_t k = 0; k < directions.size(); ++k) {
            cells.push_back({"fibre_direction_of_ply_" + std::to_string(k + 1),
                             std::span<const Vector3d>(directions[k])});
        }
        const WallArrays& walls = layup_.walls();
        if (!walls.asked_layers.empty()) {
            cells.push_back({"wall_layers_asked", std::span(walls.asked_layers)});
            cells.push_back({"wall_layers_laid", std::span(walls.laid_layers)});
        }
        const std::vector<LayupArrays>& each = layup_.each();
        for (std::size_t i = 0; each.size() > 1 && i < each.size(); ++i) {
            add_cells(each[i], "_of_layer_" + std::to_string(i + 1), cells);
        }
        return layup_vtu(surface_.position_mm, surface_.face, cells);
    }

    [[nodiscard]] std::string json() const {
        std::string text = "{\"schema\":\"meshwind-layup-1\",\"meshwind\":\"";
        text += kVersion;
        text += "\",\"frame\":\"mandrel\",\"tow\":{\"width_mm\":";
        append_shortest(text, tow_.width_mm);
        text += ",\"thickness_mm\":";
        append_shortest(text, tow_.thickness_mm);
        text += "},\n\"layers\":[";
        for (std::size_t i = 0; i < run_.layers.size(); ++i) {
            text += i > 0 ? "," : "";
            text += "{\"layer\":" + std::to_string(i + 1) + ",\"planner\":\"" +
                    name_of(run_.layers[i].plan.planner) + "\"}";
        }
        text +=
            "],\n\"ply_columns\":[\"layer\",\"fibre\",\"course\",\"angle_deg\",\"thickness_mm\"]";
        text += ",\n\"points_mm\":[\n";
        for (std::size_t i = 0; i < surface_.position_mm.size(); ++i) {
            append_vector(text, surface_.position_mm[i], kPlaces_per_mm);
            text += i + 1 < surface_.position_mm.size() ? ",\n" : "\n";
        }
        text += "],\n\"triangles\":[\n";
        for (std::size_t f = 0; f < surface_.face.size(); ++f) {
            append_triangle(text, f);
            text += f + 1 < surface_.face.size() ? ",\n" : "\n";
        }
        text += "]}\n";
        return text;
    }

private:
    // Per ply from the bottom, of each triangle; zero where there is none.
    [[nodiscard]] std::vector<std::vector<Vector3d>> directions_of_plies() const {
        std::vector<std::vector<Vector3d>> directions;
        for (std::size_t f = 0; f < surface_.face.size(); ++f) {
            const std::vector<LayupPly> plies = layup_.plies(f);
            const std::size_t told = std::min(plies.size(), kMaxDirections);
            while (directions.size() < told) {
                directions.emplace_back(surface_.face.size(), Vector3d::Zero());
            }
            const Vector3d& axis_1 = layup_.axes()[f];
            const Vector3d axis_2 = layup_.normal(f).cross(axis_1);
            for (std::size_t k = 0; k < told; ++k) {
                directions[k][f] =
                    std::cos(plies[k].angle_rad) * axis_1 + std::sin(plies[k].angle_rad) * axis_2;
            }
        }
        return directions;
    }

    static void append_rounded(std::string& text, double value, double parts) {
        append_shortest(text, std::round(value * parts) / parts);
    }

    // Above -90, also when it is rounded.
    static void append_angle(std::string& text, double angle_deg) {
        const double rounded = std::round(angle_deg * kParts_per_degree) / kParts_per_degree;
        append_shortest(text, rounded <= -90.0 ? rounded + 180.0 : rounded);
    }

    static void append_vector(std::string& text, const Vector3d& v, double parts) {
        for (int k = 0; k < 3; ++k) {
            text += k == 0 ? '[' : ',';
            append_rounded(text, v[k], parts);
        }
        text += ']';
    }

    void append_triangle(std::string& text, std::size_t f) const {
        std::string plies;
        double share = 0.0;
        for (const LayupPly& ply : layup_.plies(f)) {
            plies += (plies.empty() ? "[" : ",[") + std::to_string(ply.layer + 1) + ',' +
                     std::to_string(ply.fibre + 1) + ',' + std::to_string(ply.course) + ',';
            append_angle(plies, deg_from_rad(ply.angle_rad));
            plies += ',';
            append_rounded(plies, ply.share * tow_.thickness_mm, kPlaces_per_mm);
            plies += ']';
            share += ply.share;
        }
        const auto& [a, b, c] = surface_.face[f];
        text += "{\"points\":[" + std::to_string(a) + ',' + std::to_string(b) + ',' +
                std::to_string(c) + "],\"region\":" + std::to_string(surface_.region[f]) +
                ",\"area_mm2\":";
        append_rounded(text, layup_.all().area_mm2[f], kPlaces_per_mm);
        text += ",\"layers\":";
        append_rounded(text, share, kParts_per_layer);
        text += ",\"thickness_mm\":";
        append_rounded(text, share * tow_.thickness_mm, kPlaces_per_mm);
        text += ",\"axis_1\":";
        append_vector(text, layup_.axes()[f], kParts_per_unit);
        text += ",\"axis_2\":";
        append_vector(text, layup_.normal(f).cross(layup_.axes()[f]), kParts_per_unit);
        text += ",\"plies\":[" + plies + "]}";
    }

    const Run& run_;
    const Layup& layup_;
    const Surface& surface_;
    const Job::TowJob& tow_;
};

}  // namespace

std::vector<MadeFile> layup_files(const Run& run, const Layup& layup) {
    std::vector<MadeFile> files;
    const LayupWriter writer(run, layup);
    files.push_back({"layup.vtu", writer.vtu()});
    files.push_back({"layup.json", writer.json()});
    for (std::size_t layer = 0; layer < run.layers.size(); ++layer) {
        const auto fibres = fibres_of(run.layers[layer].plan.pieces);
        for (std::size_t fibre = 0; fibre < fibres.size(); ++fibre) {
            const std::string name = "fibre" + layer_suffix(layer) + fibre_suffix(fibre);
            const std::vector<FibreLine> lines = fibre_lines(fibres[fibre]);
            files.push_back({name + ".obj", fibre_obj(lines)});
            files.push_back({name + ".step", fibre_step(lines, name, kVersion)});
        }
    }
    return files;
}

}  // namespace meshwind
