#include "cli/shell_commands.h"

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "cli/inputs.h"
#include "core/error.h"
#include "core/files/project_files.h"
#include "core/files/write_file.h"
#include "report/shell/decks.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

// Without any load the wall is put under pressure: of 1 MPa, so that what it bears is read in MPa.
constexpr double kPressure_mpa = 1.0;

ShellWall wall_of(ShellArguments& arguments) {
    ShellRequest& request = arguments.request;
    request.run = arguments.run;
    request.material = find_input(arguments.material);
    request.loads.moment_nmm = vector_of("--moment", arguments.moment);
    if (!arguments.rims.empty()) {
        if (arguments.rims.size() != 2 || std::ranges::count(arguments.rims, 0U) > 0) {
            throw InputError("shell.no_rim", "--rims", "takes two numbers of rims, from 1: 1,3");
        }
        request.loads.rims = {arguments.rims[0] - 1, arguments.rims[1] - 1};
    }
    if (!arguments.pressure_given && request.loads.axial_n == 0.0 &&
        request.loads.moment_nmm.isZero()) {
        request.loads.pressure_mpa = kPressure_mpa;
    }
    return read_shell_wall(request);
}

}  // namespace

int run_export_fe(ShellArguments& arguments, const Common& common) {
    const auto& formats = deck_formats();
    const auto format = std::ranges::find(formats, arguments.format, &DeckFormat::name);
    const ShellWall wall = wall_of(arguments);
    const fs::path file =
        arguments.out.empty() ? "wall" + std::string(format->ending) : arguments.out;
    write_file(file, format->write(
                         shell_model(wall.mesh, wall.material, wall.request.loads, format->order)));
    if (common.json) {
        std::cout << shell_wall_json(wall);
    } else if (!common.quiet) {
        print_shell_wall(std::cout, wall);
        std::cout << "deck      " << file.string() << '\n';
    }
    return kDone;
}

int run_strength(ShellArguments& arguments, const Common& common) {
    const ShellWall wall = wall_of(arguments);
    if (!wall.material.strength) {
        throw InputError("material.no_strength", wall.request.material.string(),
                         "has no strengths; write ply.strength");
    }
    const fs::path folder = arguments.out.empty() ? "meshwind-strength" : arguments.out;
    fs::create_directories(folder);
    const Strength strength = compute_strength(
        shell_model(wall.mesh, wall.material, wall.request.loads, ElementOrder::Quadratic), folder);
    const std::string json = strength_json(wall, strength);
    write_file(folder / "strength.vtu", strength_vtu(wall, strength));
    const std::string page = strength_page(wall, strength);
    if (!page.empty()) {
        write_file(folder / "strength.html", page);
    }
    write_file(folder / "strength.json", json);
    if (common.json) {
        std::cout << json;
    } else if (!common.quiet) {
        print_strength(std::cout, wall, strength);
        std::cout << "files     " << (folder / "strength.json").string()
                  << (page.empty() ? "" : ", strength.html") << ", strength.vtu\n";
    }
    return kDone;
}

}  // namespace meshwind
