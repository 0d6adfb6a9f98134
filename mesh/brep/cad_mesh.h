/// A CAD part as even triangles whose vertices lie on its exact faces.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/cad_face.h"
#include "mesh/smooth/jet_fit.h"
#include "mesh/triangle_soup.h"

namespace meshwind {

/// Triangles of a part in mm, in the part's frame, outside counter-clockwise. Vertices shared by
/// faces occur once. Arrays per triangle are as long as `soup.faces`.
struct CadMesh {
    TriangleSoup soup;
    std::vector<std::int32_t> face;                ///< per triangle: index in `faces`
    std::vector<std::array<std::int32_t, 3>> jet;  ///< per triangle's corner: in `jets`, -1: none
    std::vector<Jet> jets;       ///< the exact faces about vertices, of degree four
    std::vector<CadFace> faces;  ///< in the file's order
    double unit_mm = 1.0;        ///< length of a file unit
    double off_face_mm = 0.0;    ///< largest distance of a shared vertex from one of its faces
    int open_edges = 0;          ///< edges of the part with one face only
    int sewn_edges = 0;          ///< edges sewn between faces that were apart
};

/// Serialises a mesh for another process on the same computer.
[[nodiscard]] std::string bytes_of(const CadMesh& mesh);

/// Deserialises it. \throws InputError mesh.cad_failed with `name`: the bytes are not those of a
/// mesh
[[nodiscard]] CadMesh cad_mesh_of(std::string_view bytes, const std::string& name);

}  // namespace meshwind
