/// The command `meshwind make KIND [--PARAM V ...] -o FILE`, after option parsing.
#pragma once

#include <filesystem>
#include <string>

#include "cli/commands.h"
#include "mesh/shapes/make_kinds.h"

namespace meshwind {

/// Line for the option's help: meaning, unit and default.
[[nodiscard]] std::string help_of(const MakeParameter& parameter);

struct MakeRequest {
    std::string kind;
    MakeValues
        shown_values;  ///< as the user gave them: mm or degrees; missing ones take their default
    MakeOptions options;
    std::filesystem::path output;  ///< .stl, .obj, .ply or .off
};

/// Makes the mesh and writes it. The file's name is checked before the mesh is made.
/// \return one line about it: file, points, triangles, area
/// \throws InputError make.*, export.unknown_format; IoError export.unwritable
[[nodiscard]] std::string run_make(const MakeRequest& request);

/// The command: the line goes to stdout. \throws InputError cli.output, and as run_make()
[[nodiscard]] int run_make_command(MakeRequest& request, const Common& common);

}  // namespace meshwind
