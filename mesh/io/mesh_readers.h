/// Parsers of the mesh formats: points and polygons. Nothing but the given bytes is read, time and
/// memory are linear in them, and every count and index is checked.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "mesh/io/polygon_soup.h"

namespace meshwind {

/// Wavefront OBJ: `v` and `f`. Other statements (normals, groups, materials, lines, curves) are
/// skipped; files that it names are not opened.
/// \param file name for the errors
/// \throws InputError mesh.bad_line, mesh.bad_index, mesh.large_polygon; Interrupted
[[nodiscard]] PolygonSoup read_obj(std::string_view bytes, const std::string& file);

/// OFF as text, also with normals, colours or texture (NOFF, COFF, STOFF), which are skipped.
/// \throws InputError as read_obj() and mesh.not_a_mesh, mesh.truncated; Interrupted
[[nodiscard]] PolygonSoup read_off(std::string_view bytes, const std::string& file);

/// PLY as text or binary of either order of bytes: x, y, z of `vertex`, vertex_indices of `face` or
/// of `tristrips`; other elements and properties are skipped.
/// \throws InputError as read_off(); Interrupted
[[nodiscard]] PolygonSoup read_ply(std::string_view bytes, const std::string& file);

/// STL as text: the facets of all its solids, three points of their own each.
/// \throws InputError mesh.bad_line, mesh.not_a_mesh, mesh.truncated; Interrupted
[[nodiscard]] PolygonSoup read_text_stl(std::string_view bytes, const std::string& file);

/// STL as text or binary, by its size. \throws InputError as read_text_stl(), read_binary_stl()
[[nodiscard]] TriangleSoup read_stl(std::string_view bytes, const std::string& file);

constexpr std::size_t kStlHeaderBytes = 84;    ///< 80 bytes of text and the triangle count
constexpr std::size_t kStlTriangleBytes = 50;  ///< normal, three points, attribute

/// Triangles that the header of a binary STL announces. \pre bytes has kStlHeaderBytes
[[nodiscard]] std::size_t stl_count(std::string_view bytes);

/// Binary STL, three points of their own for each triangle. Bytes behind the last one are padding.
/// \throws InputError mesh.truncated, mesh.not_a_mesh
[[nodiscard]] TriangleSoup read_binary_stl(std::string_view bytes, const std::string& file);

/// A mesh format that is read, by the ending of its files.
struct MeshReader {
    std::string_view ending;  ///< in lower case
    TriangleSoup (*read)(std::string_view bytes, const std::string& file);
};

template <PolygonSoup (*read)(std::string_view, const std::string&)>
TriangleSoup read_polygons(std::string_view bytes, const std::string& file) {
    return triangles_of(read(bytes, file));
}

/// One row per format.
inline constexpr std::array kMeshReaders = {
    MeshReader{".stl", read_stl},
    MeshReader{".obj", read_polygons<read_obj>},
    MeshReader{".ply", read_polygons<read_ply>},
    MeshReader{".off", read_polygons<read_off>},
};

}  // namespace meshwind
