/// Reads CAD files (STEP, IGES, BREP) by the program meshwind-cad (mesh/brep/occt).
#pragma once

#include <filesystem>
#include <string>

#include "mesh/brep/cad_mesh.h"

namespace meshwind {

/// Whether a file is read as CAD: .step, .stp, .iges, .igs or .brep.
[[nodiscard]] bool is_cad(const std::filesystem::path& file);

/// Meshes a CAD file's faces with even triangles. The program is searched for in $MESHWIND_CAD,
/// beside this one, where it is installed, and where it was built; it may take 6 GB. Waiting is a
/// cancellation point.
/// \param solid name or number, from 1; empty: the only one \param edge_mm longest edge; 0: by the
/// part's size
/// \throws IoError mesh.missing_file, mesh.unreadable; InputError mesh.no_cad (the program is not
/// installed), mesh.not_cad, mesh.empty_cad, mesh.several_solids, mesh.no_such_solid,
/// mesh.cad_face, mesh.cad_tolerance, mesh.cad_failed; Interrupted
[[nodiscard]] CadMesh read_cad(const std::filesystem::path& file, const std::string& solid,
                               double edge_mm);

}  // namespace meshwind
