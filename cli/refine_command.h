/// `meshwind inspect --refine`: the winding surface with shorter edges, as a mesh file.
#pragma once

#include <cstddef>
#include <filesystem>

#include "mesh/mandrel.h"

namespace meshwind {

/// Writes the winding surface refined onto its curved patches (mesh/refine.h), in the frame and
/// units of the mandrel's file. \param edge_mm longest edge, mm whatever the file's unit
/// \return number of triangles \throws what `refined` and `write_mesh_file` throw; a name of no
/// mesh format is refused before anything is made
std::size_t write_refined(const Mandrel& mandrel, double edge_mm,
                          const std::filesystem::path& file);

}  // namespace meshwind
