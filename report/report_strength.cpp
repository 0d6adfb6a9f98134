#include "report/report_strength.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/text/text_number.h"
#include "core/units.h"
#include "core/version.h"
#include "mesh/triangle_soup.h"
#include "report/layup_vtu.h"
#include "report/page/packed_page.h"
#include "report/page/page_arrays.h"
#include "report/report_checks.h"

namespace meshwind {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::ordered_json;

double radius_mm(const ShellRim& rim) {
    return std::sqrt(rim.area_mm2.norm() / kPi);
}

Vector3d middle_of(const ShellMesh& mesh, std::size_t f) {
    Vector3d sum = Vector3d::Zero();
    for (const std::int32_t point : mesh.triangle[f].point) {
        sum += mesh.point_mm[static_cast<std::size_t>(point)];
    }
    return sum / 3.0;
}

Json json_of(const ShellWall& wall) {
    Json rims = Json::array();
    for (const ShellRim& rim : wall.mesh.rim) {
        rims.push_back({{"rim", rims.size() + 1},
                        {"centre_mm", report_vector(rim.centre_mm)},
                        {"radius_mm", report_number(radius_mm(rim))}});
    }
    const ShellLoads& loads = wall.request.loads;
    return {{"meshwind", kVersion},
            {"material", wall.material.name},
            {"loads",
             {{"pressure_MPa", report_number(loads.pressure_mpa)},
              {"axial_N", report_number(loads.axial_n)},
              {"moment_Nmm", report_vector(loads.moment_nmm)}}},
            {"shells", wall.mesh.triangle.size()},
            {"bare", wall.mesh.bare()},
            {"plies",
             {{"laid", wall.merge.plies_before},
              {"computed", wall.merge.plies_after},
              {"most", wall.mesh.most_plies()},
              {"turned_deg", report_number(deg_from_rad(wall.merge.worst_rad))}}},
            {"rims", rims}};
}

Json json_of(const ShellWall& wall, const PlyState& state) {
    if (!std::isfinite(state.reserve)) {
        return nullptr;
    }
    const ShellPly& ply = wall.mesh.triangle[state.triangle].plies[state.ply];
    return {{"reserve", report_number(state.reserve)},
            {"layer", ply.layer + 1},
            {"shell", state.triangle + 1},
            {"ply", state.ply + 1},
            {"position_mm", report_vector(middle_of(wall.mesh, state.triangle))},
            {"angle_deg", report_number(deg_from_rad(ply.angle_rad))},
            {"stress_MPa",
             {{"along", report_number(state.stress.along)},
              {"across", report_number(state.stress.across)},
              {"shear", report_number(state.stress.shear)}}}};
}

// What 99 % of the wall, by area, has at least: a bare spot is as small as its triangle.
constexpr double kFewest = 0.01;

double reserve_of_most(const ShellMesh& mesh, const Strength& strength) {
    std::vector<std::pair<double, double>> parts;  // reserve, area
    double whole = 0.0;
    for (std::size_t f = 0; f < mesh.triangle.size(); ++f) {
        const auto& point = mesh.triangle[f].point;
        const double area = area_mm2(mesh.point_mm, point);
        whole += area;
        parts.emplace_back(strength.reserve[f], area);
    }
    std::sort(parts.begin(), parts.end());
    double sum = 0.0;
    for (const auto& [reserve, area] : parts) {
        sum += area;
        if (sum >= kFewest * whole) {
            return reserve;
        }
    }
    return parts.back().first;
}

Json json_of(const ShellWall& wall, const Strength& strength) {
    Json json = json_of(wall);
    json["first_failure"] = json_of(wall, strength.first);
    json["reserve_of_99_percent"] = report_number(reserve_of_most(wall.mesh, strength));
    json["layers"] = Json::array();
    for (const PlyState& layer : strength.layers) {
        json["layers"].push_back(json_of(wall, layer));
    }
    return json;
}

// What both the page and the file for ParaView show of each triangle.
struct WallCells {
    std::vector<std::array<std::int32_t, 3>> triangles;
    std::vector<double> thickness_mm, utilisation;
    std::vector<std::int32_t> plies;

    WallCells(const ShellWall& wall, const Strength& strength) {
        for (std::size_t f = 0; f < wall.mesh.triangle.size(); ++f) {
            const ShellTriangle& triangle = wall.mesh.triangle[f];
            triangles.push_back(triangle.point);
            plies.push_back(static_cast<std::int32_t>(triangle.plies.size()));
            thickness_mm.push_back(std::accumulate(
                triangle.plies.begin(), triangle.plies.end(), 0.0,
                [](double sum, const ShellPly& ply) { return sum + ply.thickness_mm; }));
            utilisation.push_back(1.0 / strength.reserve[f]);
        }
    }
};

std::string place(const Vector3d& v) {
    return fixed(v.x(), 1) + ", " + fixed(v.y(), 1) + ", " + fixed(v.z(), 1);
}

std::string words_of(const ShellLoads& loads) {
    std::string text;
    const auto add = [&](const std::string& load) { text += (text.empty() ? "" : ", ") + load; };
    if (loads.pressure_mpa != 0.0) {
        add(fixed(loads.pressure_mpa, 2) + " MPa inside");
    }
    if (loads.axial_n != 0.0) {
        add(fixed(loads.axial_n, 0) + " N along");
    }
    if (!loads.moment_nmm.isZero()) {
        add("a moment of " + fixed(loads.moment_nmm.norm() * 1e-3, 1) + " N m");
    }
    return text;
}

}  // namespace

ShellWall read_shell_wall(const ShellRequest& request) {
    ShellWall wall{.request = request,
                   .mesh = read_shell_mesh(request.run),
                   .material = read_wall_material(request.material),
                   .merge = {}};
    wall.merge = merge_plies(wall.mesh, rad_from_deg(request.merge_deg), request.most_plies);
    return wall;
}

std::string shell_wall_json(const ShellWall& wall) {
    return json_of(wall).dump(1) + "\n";
}

void print_shell_wall(std::ostream& out, const ShellWall& wall) {
    out << "wall      " << wall.mesh.triangle.size() << " shells, " << wall.merge.plies_after
        << " plies of " << wall.merge.plies_before << " laid, up to " << wall.mesh.most_plies()
        << "; angles moved by " << degrees(wall.merge.worst_rad, 1) << " at most\n";
    if (const std::size_t bare = wall.mesh.bare(); bare > 0) {
        out << "bare      " << bare
            << " shells: " << (wall.material.liner ? "the liner alone" : "matrix as thick as a tow")
            << '\n';
    }
    out << "material  " << wall.material.name << "\nloads     " << words_of(wall.request.loads)
        << "\nrims     ";
    for (std::size_t i = 0; i < wall.mesh.rim.size(); ++i) {
        out << ' ' << i + 1 << ": radius " << fixed(radius_mm(wall.mesh.rim[i]), 1) << " at "
            << place(wall.mesh.rim[i].centre_mm) << (i + 1 < wall.mesh.rim.size() ? ";" : "");
    }
    out << '\n';
}

std::string strength_json(const ShellWall& wall, const Strength& strength) {
    return json_of(wall, strength).dump(1) + "\n";
}

void print_strength(std::ostream& out, const ShellWall& wall, const Strength& strength) {
    print_shell_wall(out, wall);
    const auto print = [&](const std::string& name, const PlyState& state) {
        if (!std::isfinite(state.reserve)) {
            return;
        }
        const ShellPly& ply = wall.mesh.triangle[state.triangle].plies[state.ply];
        out << name << fixed(state.reserve, 3) << " x the load, layer " << ply.layer + 1 << ", "
            << degrees(ply.angle_rad, 1) << ", at " << place(middle_of(wall.mesh, state.triangle))
            << " mm: " << fixed(state.stress.along, 1) << " MPa along the fibre, "
            << fixed(state.stress.across, 1) << " across, " << fixed(state.stress.shear, 1)
            << " shear\n";
    };
    print("fails at  ", strength.first);
    const double reserve = reserve_of_most(wall.mesh, strength);
    if (std::isfinite(reserve)) {
        out << "99 %      of the wall bear " << fixed(reserve, 3) << " x the load\n";
    }
    for (std::size_t i = 0; strength.layers.size() > 1 && i < strength.layers.size(); ++i) {
        print("layer " + std::to_string(i + 1) + "   ", strength.layers[i]);
    }
}

std::string strength_page(const ShellWall& wall, const Strength& strength) {
    const std::string_view page = strength_page_template();
    if (page.empty()) {
        return {};
    }
    const WallCells cells(wall, strength);
    PageArrays arrays;
    arrays.add_points("wall/points", wall.mesh.point_mm);
    arrays.add_faces("wall/faces", cells.triangles);
    arrays.add_floats("wall/utilisation", cells.utilisation);
    arrays.add_floats("wall/thickness", cells.thickness_mm);
    arrays.add<std::int32_t>("wall/plies", 1, cells.plies);
    std::ostringstream text;
    print_strength(text, wall, strength);
    const std::filesystem::path run = std::filesystem::absolute(wall.request.run);
    return packed_page(page, arrays.behind({{"format", "meshwind-strength-1"},
                                            {"strength", json_of(wall, strength)},
                                            {"text", text.str()},
                                            {"name", run.filename().string()}}));
}

std::string strength_vtu(const ShellWall& wall, const Strength& strength) {
    const WallCells cells(wall, strength);
    return layup_vtu(
        wall.mesh.point_mm, cells.triangles,
        std::vector<CellArray>{{"utilisation", std::span<const double>(cells.utilisation)},
                               {"thickness_mm", std::span<const double>(cells.thickness_mm)},
                               {"plies", std::span<const std::int32_t>(cells.plies)}});
}

}  // namespace meshwind
