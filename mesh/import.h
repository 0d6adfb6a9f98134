/// Triangles from mesh files, in the units and the frame of the file.
#pragma once

#include <filesystem>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Reads every triangle of an STL (binary, ASCII), OBJ, PLY or OFF file; larger polygons are split,
/// several solids or objects are joined in file order. Points are as the file holds them (single
/// precision, one copy per object or per face): weld them next. Coordinates are in file units.
/// \throws IoError mesh.missing_file, mesh.unreadable; InputError mesh.empty_file,
/// mesh.unknown_format, mesh.not_a_mesh, mesh.truncated, mesh.not_finite, mesh.no_triangles
[[nodiscard]] TriangleSoup read_triangles(const std::filesystem::path& file);

/// Length in mm of the unit that the file's header or comments state ("UNITS=mm", "unit: inch");
/// 0 when it states none, as most do.
/// \throws IoError mesh.missing_file
[[nodiscard]] double stated_unit_mm(const std::filesystem::path& file);

}  // namespace meshwind
