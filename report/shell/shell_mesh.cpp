#include "report/shell/shell_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/text/strict_json.h"
#include "core/units.h"
#include "mesh/edge_table.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;

namespace fs = std::filesystem;

// The columns of a ply, as layup.json names them.
constexpr std::size_t kPlyColumns = 5;
constexpr std::size_t kLayer = 0;
constexpr std::size_t kAngle = 3;
constexpr std::size_t kThickness = 4;

ShellPly read_ply(const JsonValue& value) {
    const std::vector<JsonValue> column = value.array();
    if (column.size() != kPlyColumns) {
        value.fail("layup.broken", "a ply has five numbers; run meshwind again");
    }
    return {static_cast<std::size_t>(
                column[kLayer].integer(1, std::numeric_limits<std::int32_t>::max()) - 1),
            rad_from_deg(column[kAngle].number({.min = -90.0, .max = 90.0})),
            column[kThickness].number({.min = 0.0})};
}

ShellTriangle read_triangle(const JsonValue& value, std::size_t points) {
    const JsonObject of = value.object(
        {"points", "region", "area_mm2", "layers", "thickness_mm", "axis_1", "axis_2", "plies"});
    ShellTriangle triangle;
    const JsonValue corners = of.required("points");
    const std::vector<JsonValue> corner = corners.array();
    if (corner.size() != triangle.point.size()) {
        corners.fail("layup.broken", "a triangle has three points; run meshwind again");
    }
    for (std::size_t k = 0; k < corner.size(); ++k) {
        triangle.point[k] =
            static_cast<std::int32_t>(corner[k].integer(0, static_cast<long long>(points) - 1));
    }
    triangle.axis_1 = of.required("axis_1").vector3();
    triangle.axis_2 = of.required("axis_2").vector3();
    for (const JsonValue& ply : of.required("plies").array()) {
        if (const ShellPly read = read_ply(ply); read.thickness_mm > 0.0) {
            triangle.plies.push_back(read);
        }
    }
    return triangle;
}

// Edges that one triangle has, as lids over the holes run along them: from end to beginning.
std::map<std::int32_t, std::int32_t> open_edges(const std::vector<ShellTriangle>& triangles) {
    std::vector<std::array<std::int32_t, 3>> faces;
    faces.reserve(triangles.size());
    for (const ShellTriangle& triangle : triangles) {
        faces.push_back(triangle.point);
    }
    const std::vector<EdgeUse> uses = edge_uses(faces);
    const auto same = [](const EdgeUse& a, const EdgeUse& b) {
        return a.low == b.low && a.high == b.high;
    };
    std::map<std::int32_t, std::int32_t> next;
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const bool shared = (i > 0 && same(uses[i - 1], uses[i])) ||
                            (i + 1 < uses.size() && same(uses[i], uses[i + 1]));
        if (!shared) {
            const bool ascending = uses[i].ascending != 0;
            next[ascending ? uses[i].high : uses[i].low] = ascending ? uses[i].low : uses[i].high;
        }
    }
    return next;
}

std::vector<ShellRim> find_shell_rims(const ShellMesh& mesh) {
    std::map<std::int32_t, std::int32_t> next = open_edges(mesh.triangle);
    std::vector<ShellRim> rims;
    while (!next.empty()) {
        ShellRim rim;
        for (auto at = next.begin(); at != next.end(); at = next.find(rim.point.back())) {
            rim.point.push_back(at->second);
            next.erase(at);
        }
        const auto position = [&](std::size_t i) -> const Vector3d& {
            return mesh.point_mm[static_cast<std::size_t>(rim.point[i % rim.point.size()])];
        };
        rim.centre_mm = Vector3d::Zero();
        rim.area_mm2 = Vector3d::Zero();
        for (std::size_t i = 0; i < rim.point.size(); ++i) {
            rim.centre_mm += position(i) / static_cast<double>(rim.point.size());
            rim.area_mm2 += 0.5 * position(i).cross(position(i + 1));
        }
        rims.push_back(rim);
    }
    return rims;
}

// Angle between two lines, 0 .. pi/2.
double between_rad(const ShellPly& a, const ShellPly& b) {
    return std::abs(std::remainder(a.angle_rad - b.angle_rad, kPi));
}

// The direction of twice the angle has no sense to lose. Returns the further of both turns.
double merge_into(ShellPly& low, const ShellPly& high) {
    const double mean =
        std::remainder(0.5 * std::atan2(low.thickness_mm * std::sin(2.0 * low.angle_rad) +
                                            high.thickness_mm * std::sin(2.0 * high.angle_rad),
                                        low.thickness_mm * std::cos(2.0 * low.angle_rad) +
                                            high.thickness_mm * std::cos(2.0 * high.angle_rad)),
                       kPi);
    const ShellPly merged{low.layer, mean, low.thickness_mm + high.thickness_mm};
    const double turned = std::max(between_rad(low, merged), between_rad(high, merged));
    low = merged;
    return turned;
}

struct NearestPlies {
    std::size_t low = 0, high = 0;
    double apart_rad = std::numeric_limits<double>::infinity();
};

NearestPlies nearest_plies(const std::vector<ShellPly>& plies, bool of_one_layer) {
    NearestPlies nearest;
    for (std::size_t high = 1; high < plies.size(); ++high) {
        for (std::size_t low = 0; low < high; ++low) {
            const double apart = between_rad(plies[low], plies[high]);
            if (apart < nearest.apart_rad &&
                (!of_one_layer || plies[low].layer == plies[high].layer)) {
                nearest = {low, high, apart};
            }
        }
    }
    return nearest;
}

}  // namespace

std::size_t ShellMesh::most_plies() const {
    std::size_t most = 0;
    for (const ShellTriangle& one : triangle) {
        most = std::max(most, one.plies.size());
    }
    return most;
}

std::size_t ShellMesh::bare() const {
    return static_cast<std::size_t>(
        std::count_if(triangle.begin(), triangle.end(),
                      [](const ShellTriangle& one) { return one.plies.empty(); }));
}

ShellMesh read_shell_mesh(const fs::path& file) {
    const fs::path table = fs::is_directory(file) ? file / "layup.json" : file;
    const JsonDocument document = JsonDocument::load(table.string());
    const JsonObject of = document.root().object(
        {"schema", "meshwind", "frame", "tow", "layers", "ply_columns", "points_mm", "triangles"});
    static_cast<void>(of.required("schema").one_of({"meshwind-layup-1"}));
    ShellMesh mesh;
    mesh.tow_thickness_mm = of.required("tow")
                                .object({"width_mm", "thickness_mm"})
                                .required("thickness_mm")
                                .number({.min = 0.0, .above_min = true});
    for (const JsonValue& point : of.required("points_mm").array()) {
        mesh.point_mm.push_back(point.vector3());
    }
    for (const JsonValue& triangle : of.required("triangles").array()) {
        mesh.triangle.push_back(read_triangle(triangle, mesh.point_mm.size()));
    }
    if (mesh.triangle.empty()) {
        throw InputError("layup.broken", table.string(), "has no triangles; run meshwind again");
    }
    mesh.rim = find_shell_rims(mesh);
    return mesh;
}

PlyMerge merge_plies(ShellMesh& mesh, double near_rad, std::size_t most) {
    PlyMerge merge;
    for (ShellTriangle& triangle : mesh.triangle) {
        std::vector<ShellPly>& plies = triangle.plies;
        merge.plies_before += plies.size();
        while (true) {
            NearestPlies pair = nearest_plies(plies, true);
            if (pair.apart_rad >= near_rad) {
                pair = plies.size() > most ? nearest_plies(plies, false) : NearestPlies{};
            }
            if (pair.high == 0) {
                break;
            }
            merge.worst_rad =
                std::max(merge.worst_rad, merge_into(plies[pair.low], plies[pair.high]));
            plies.erase(plies.begin() + static_cast<std::ptrdiff_t>(pair.high));
        }
        merge.plies_after += plies.size();
    }
    return merge;
}

}  // namespace meshwind
