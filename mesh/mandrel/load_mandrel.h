/// Loads a mandrel from a user's file: units, repair, regions, rims, spindle axis.
#pragma once

#include <filesystem>
#include <string>

#include "mesh/mandrel.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// Reads, repairs, segments and freezes a mandrel file: triangles (STL, OBJ, PLY, OFF), outlines
/// (mesh/profile/profile_file.h) or CAD (mesh/brep/read_cad.h), with exact normals and curvature.
/// \throws IoError mesh.unreadable; InputError mesh.* with the file, the place and the remedy
[[nodiscard]] Mandrel load_mandrel(const std::filesystem::path& file,
                                   const MandrelOptions& options = {});

/// The same from triangles in memory; `name` stands in for the file's name.
[[nodiscard]] Mandrel build_mandrel(const TriangleSoup& file_units, const std::string& name,
                                    const MandrelOptions& options = {});

/// The winding surface with edges of at most `edge_mm` (mesh/smooth/refine.h), in the frame and
/// units of the mandrel's file. \throws InputError refine.*
[[nodiscard]] TriangleSoup refined_wall(const Mandrel& mandrel, double edge_mm);

}  // namespace meshwind
