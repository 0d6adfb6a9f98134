#include "cli/layup_files.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "cli/layup_vtu.h"
#include "cli/run_files.h"
#include "core/text_number.h"
#include "core/units.h"
#include "postproc/fibre_lines.h"
#include "version.h"
#include "winding/material_axes.h"
#include "winding/plies.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

// What the numbers of layup.json are rounded to: far below the tolerances of a winding.
constexpr double kPlaces_per_mm = 1e6;     // lengths, areas, thicknesses
constexpr double kParts_per_unit = 1e7;    // unit vectors
constexpr double kParts_per_degree = 1e3;  // angles
constexpr double kParts_per_layer = 1e6;   // numbers of layers

struct Triangle {
    Vector3d normal;
    double area_mm2 = 0.0;
};

Triangle triangle_of(const Surface& surface, std::size_t face) {
    const auto corner = [&](std::size_t k) -> const Vector3d& {
        return surface.position_mm[static_cast<std::size_t>(surface.face[face][k])];
    };
    const Vector3d twice = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    const double length = twice.norm();
    return {twice / length, 0.5 * length};
}

// A ply as it is told.
struct ToldPly {
    std::size_t layer = 0;
    std::size_t fibre = 0;
    std::size_t course = 0;
    double share = 0.0;
    double angle_rad = 0.0;             // from the triangle's axis
    double angle_to_spindle_rad = 0.0;  // 0 .. pi/2
};

// The plies of one layer in the frames of the bare mandrel's triangles.
class LayerPlies {
public:
    LayerPlies(const WoundLayer& layer, std::size_t number, const std::vector<Vector3d>& axes,
               std::uint64_t seed)
        : surface_(layer.setup.mandrel.surface),
          number_(number),
          axes_(axes),
          plies_(plies_of(surface_, layer.import ? layer.setup.wall->surface() : surface_,
                          layer.plan.pieces,
                          {.tow_width_mm = layer.setup.job.tow.width_mm,
                           .seed = seed,
                           .over_rims = layer.plan.planner != "cover"})) {
        const auto fibres = fibres_of(layer.plan.pieces);
        for (std::size_t fibre = 0; fibre < fibres.size(); ++fibre) {
            for (std::size_t course = 0; course < fibres[fibre].size(); ++course) {
                place_.emplace_back(fibre, course);
            }
        }
    }

    [[nodiscard]] const Plies& plies() const { return plies_; }
    [[nodiscard]] const Surface& surface() const { return surface_; }

    [[nodiscard]] std::vector<ToldPly> of(std::size_t face) const {
        std::vector<ToldPly> told;
        if (plies_.of(face).empty()) {
            return told;
        }
        const Vector3d normal = triangle_of(surface_, face).normal;
        const Vector3d axis = (axes_[face] - normal * normal.dot(axes_[face])).normalized();
        for (const Ply& ply : plies_.of(face)) {
            const auto& [fibre, course] = place_[static_cast<std::size_t>(ply.piece)];
            told.push_back({number_, fibre, course, ply.share,
                            ply_angle_rad(axis, normal, ply.along),
                            std::acos(std::min(1.0, std::abs(ply.along.z())))});
        }
        return told;
    }

private:
    const Surface& surface_;
    std::size_t number_;
    const std::vector<Vector3d>& axes_;
    Plies plies_;
    std::vector<std::pair<std::size_t, std::size_t>> place_;  // per piece: fibre, course
};

// Arrays of layup.vtu, per triangle: of one layer or of all.
struct LayupArrays {
    explicit LayupArrays(std::size_t faces)
        : layers(faces),
          thickness_mm(faces),
          spindle_deg(faces),
          winding_deg(faces),
          area_mm2(faces),
          covered(faces),
          share(faces) {}

    std::vector<double> layers;
    std::vector<double> thickness_mm;
    std::vector<double> spindle_deg;
    std::vector<double> winding_deg;
    std::vector<double> area_mm2;
    std::vector<double> covered;
    std::vector<double> share;  // of all plies, to divide the angles by; not told
    std::vector<std::int32_t> samples;
};

void add_angles(const LayerPlies& layer, LayupArrays& arrays) {
    for (std::size_t f = 0; f < arrays.layers.size(); ++f) {
        for (const ToldPly& ply : layer.of(f)) {
            arrays.share[f] += ply.share;
            arrays.spindle_deg[f] += ply.share * deg_from_rad(ply.angle_to_spindle_rad);
            arrays.winding_deg[f] += ply.share * std::abs(deg_from_rad(ply.angle_rad));
        }
    }
}

void divide_angles(LayupArrays& arrays) {
    for (std::size_t f = 0; f < arrays.layers.size(); ++f) {
        const double share = arrays.share[f] > 0.0 ? arrays.share[f] : 1.0;
        arrays.spindle_deg[f] /= share;
        arrays.winding_deg[f] /= share;
    }
}

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
    LayupWriter(const WindResult& result, std::uint64_t seed)
        : result_(result),
          bare_(result.layers.front().setup.mandrel),
          surface_(bare_.surface),
          tow_(result.layers.front().setup.job.tow),
          axes_(material_axes(bare_)) {
        for (std::size_t i = 0; i < result.layers.size(); ++i) {
            layers_.emplace_back(result.layers[i], i, axes_, seed);
        }
    }

    [[nodiscard]] std::string vtu() const {
        const std::size_t faces = surface_.face.size();
        LayupArrays all(faces);
        std::deque<LayupArrays> each;
        for (std::size_t i = 0; i < layers_.size(); ++i) {
            LayupArrays& one = each.emplace_back(arrays_of(i));
            for (std::size_t f = 0; f < faces; ++f) {
                all.layers[f] += one.layers[f];
                all.thickness_mm[f] += one.thickness_mm[f];
            }
            add_angles(layers_[i], all);
        }
        divide_angles(all);
        for (std::size_t f = 0; f < faces; ++f) {
            all.area_mm2[f] = triangle_of(surface_, f).area_mm2;
            // Samples of several layers are not the same; report.json counts as this does.
            all.covered[f] =
                layers_.size() == 1 ? each.front().covered[f] : std::min(1.0, all.layers[f]);
        }
        std::vector<CellArray> cells;
        if (layers_.size() == 1) {
            all.samples = each.front().samples;
        }
        add_cells(all, "", cells);
        cells.push_back({"region", std::span<const std::int32_t>(surface_.region)});
        for (std::size_t i = 0; layers_.size() > 1 && i < layers_.size(); ++i) {
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
        for (std::size_t i = 0; i < result_.layers.size(); ++i) {
            text += i > 0 ? "," : "";
            text += "{\"layer\":" + std::to_string(i + 1) + ",\"planner\":\"" +
                    result_.layers[i].plan.planner + "\"}";
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
    [[nodiscard]] LayupArrays arrays_of(std::size_t number) const {
        const LayerPlies& layer = layers_[number];
        const std::size_t faces = surface_.face.size();
        LayupArrays arrays(faces);
        arrays.layers = result_.layers[number].plan.face_layers;
        arrays.covered = layer.plies().covered;
        arrays.samples = layer.plies().samples;
        for (std::size_t f = 0; f < faces; ++f) {
            arrays.thickness_mm[f] = arrays.layers[f] * tow_.thickness_mm;
            arrays.area_mm2[f] = triangle_of(layer.surface(), f).area_mm2;
        }
        add_angles(layer, arrays);
        divide_angles(arrays);
        return arrays;
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
        const Triangle triangle = triangle_of(surface_, f);
        std::string plies;
        double share = 0.0;
        for (const LayerPlies& layer : layers_) {
            for (const ToldPly& ply : layer.of(f)) {
                plies += (plies.empty() ? "[" : ",[") + std::to_string(ply.layer + 1) + ',' +
                         std::to_string(ply.fibre + 1) + ',' + std::to_string(ply.course) + ',';
                append_angle(plies, deg_from_rad(ply.angle_rad));
                plies += ',';
                append_rounded(plies, ply.share * tow_.thickness_mm, kPlaces_per_mm);
                plies += ']';
                share += ply.share;
            }
        }
        const auto& [a, b, c] = surface_.face[f];
        text += "{\"points\":[" + std::to_string(a) + ',' + std::to_string(b) + ',' +
                std::to_string(c) + "],\"region\":" + std::to_string(surface_.region[f]) +
                ",\"area_mm2\":";
        append_rounded(text, triangle.area_mm2, kPlaces_per_mm);
        text += ",\"layers\":";
        append_rounded(text, share, kParts_per_layer);
        text += ",\"thickness_mm\":";
        append_rounded(text, share * tow_.thickness_mm, kPlaces_per_mm);
        text += ",\"axis_1\":";
        append_vector(text, axes_[f], kParts_per_unit);
        text += ",\"axis_2\":";
        append_vector(text, triangle.normal.cross(axes_[f]), kParts_per_unit);
        text += ",\"plies\":[" + plies + "]}";
    }

    const WindResult& result_;
    const Mandrel& bare_;
    const Surface& surface_;
    const Job::TowJob& tow_;
    std::vector<Vector3d> axes_;  // per triangle of the bare mandrel
    std::deque<LayerPlies> layers_;
};

}  // namespace

std::vector<MadeFile> layup_files(const WindResult& result, std::uint64_t seed) {
    std::vector<MadeFile> files;
    const LayupWriter writer(result, seed);
    files.push_back({"layup.vtu", writer.vtu()});
    files.push_back({"layup.json", writer.json()});
    for (std::size_t layer = 0; layer < result.layers.size(); ++layer) {
        const auto fibres = fibres_of(result.layers[layer].plan.pieces);
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
