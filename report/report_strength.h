/// Inputs and report of a finite element model of a run.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

#include "report/shell/shell_mesh.h"
#include "report/shell/shell_model.h"
#include "report/shell/strength.h"
#include "report/shell/wall_material.h"

namespace meshwind {

struct ShellRequest {
    std::filesystem::path run;  ///< folder of a run, or its layup.json
    std::filesystem::path material;
    ShellLoads loads;
    double merge_deg = 5.0;       ///< plies of a layer within this angle are merged
    std::size_t most_plies = 15;  ///< of an element: memory grows with it
};

struct ShellWall {
    ShellRequest request;
    ShellMesh mesh;  ///< with merged plies
    WallMaterial material;
    PlyMerge merge;
};

/// \throws Error as read_shell_mesh() and read_wall_material()
[[nodiscard]] ShellWall read_shell_wall(const ShellRequest& request);

/// JSON of material, loads, elements, plies and rims.
[[nodiscard]] std::string shell_wall_json(const ShellWall& wall);
void print_shell_wall(std::ostream& out, const ShellWall& wall);

/// The same, and the weakest ply of all and of each layer, with its place, angle and stresses.
[[nodiscard]] std::string strength_json(const ShellWall& wall, const Strength& strength);
void print_strength(std::ostream& out, const ShellWall& wall, const Strength& strength);

/// A page for the browser: the wall by utilisation and thickness, its weakest places, and the
/// printed text. Empty where the program was built without pages. The header of its data
/// (page_arrays.h) has "strength" (strength_json), "text" (print_strength) and "name"; arrays,
/// positions in the mandrel's frame, mm:
///
///     wall/points, wall/faces
///     wall/utilisation, wall/thickness (mm), wall/plies   per triangle, as in strength_vtu()
[[nodiscard]] std::string strength_page(const ShellWall& wall, const Strength& strength);

/// Per triangle thickness, plies and utilisation: the share of the load at which its first ply
/// fails, 0 without plies.
[[nodiscard]] std::string strength_vtu(const ShellWall& wall, const Strength& strength);

}  // namespace meshwind
