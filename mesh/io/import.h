/// Reads triangles from mesh files (STL, OBJ, PLY, OFF), in the units and the frame of the file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Reads every triangle of an STL (binary, text), OBJ, PLY (binary, text) or OFF file; larger
/// polygons are split, several solids or objects are joined in file order. Points are as the file
/// holds them, text as doubles, those of an STL one copy per triangle: weld them next. Coordinates
/// are in file units. No other file is opened, whatever this one names. Time and memory are linear
/// in the file's size. Some points in between are cancellation points.
/// \throws IoError mesh.missing_file, mesh.unreadable; InputError mesh.empty_file,
/// mesh.unknown_format, mesh.not_a_mesh, mesh.truncated, mesh.too_large, mesh.bad_line,
/// mesh.bad_index, mesh.large_polygon, mesh.not_finite, mesh.no_triangles, each with the line or
/// the byte; Interrupted
[[nodiscard]] TriangleSoup read_triangles(const std::filesystem::path& file);

/// Reads the bytes of a part's file. \throws as read_triangles() for a file that cannot be read
[[nodiscard]] std::string read_part_file(const std::filesystem::path& file);

/// ".stl" of "PART.STL"; empty without an ending.
[[nodiscard]] std::string lower_ending(const std::filesystem::path& file);

/// read_triangles() of a file's bytes. \param name for the errors; its ending tells the format
[[nodiscard]] TriangleSoup parse_triangles(std::string_view bytes, const std::string& name);

/// Endings of files that are read, in words: ".stl, .obj, .ply or .off".
[[nodiscard]] std::string mesh_endings();

/// Length in mm of the unit that the file's header or comments state ("UNITS=mm", "unit: inch");
/// 0 when it states none, as most do.
/// \throws IoError mesh.missing_file
[[nodiscard]] double stated_unit_mm(const std::filesystem::path& file);

}  // namespace meshwind
