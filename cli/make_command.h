/// `meshwind make KIND [--PARAM V ...] -o FILE` behind the option parser.
#pragma once

#include <filesystem>
#include <string>

#include "mesh/make_kinds.h"

namespace meshwind {

/// The number a user gives for a parameter, mm or degrees, from its value in mm or rad, and back.
[[nodiscard]] double shown_value(const MakeParameter& parameter, double value);
[[nodiscard]] double value_of_shown(const MakeParameter& parameter, double shown);

/// "mm", "deg" or "".
[[nodiscard]] std::string shown_unit(const MakeParameter& parameter);

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

}  // namespace meshwind
