/// Writes triangles to mesh files: STL, OBJ, PLY, OFF.
#pragma once

#include <filesystem>
#include <string>

#include "mesh/triangle_soup.h"

namespace meshwind {

/// Stl is binary with 32-bit numbers, as the format has it; the others are text and read back to
/// the same doubles. Coordinates are mm in the order of the soup.
enum class MeshFormat { Stl, Obj, Ply, Off };

/// The format named by the file's extension, in either case.
/// \throws InputError export.unknown_format
[[nodiscard]] MeshFormat mesh_format_of(const std::filesystem::path& file);

/// The whole file; the same soup gives the same bytes on every machine.
/// \throws InputError export.too_large for more than 2^32 - 1 STL triangles
[[nodiscard]] std::string mesh_file_bytes(const TriangleSoup& soup, MeshFormat format);

/// Writes `mesh_file_bytes` by the extension's format; the file appears complete or not at all.
/// \throws InputError export.unknown_format; IoError export.unwritable
void write_mesh_file(const TriangleSoup& soup, const std::filesystem::path& file);

}  // namespace meshwind
