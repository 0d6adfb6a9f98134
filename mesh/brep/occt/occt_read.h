/// Reads CAD files by Open CASCADE.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <TopoDS_Shape.hxx>
#include <TopoDS_TShape.hxx>

namespace meshwind {

/// "#rrggbb" of coloured faces, wherever they are placed.
using FaceColours = std::map<const TopoDS_TShape*, std::string>;

struct OcctPart {
    TopoDS_Shape shape;  ///< in mm
    double unit_mm = 1.0;
    int sewn_edges = 0;
    FaceColours colours{};  ///< of STEP files
};

/// Reads a STEP, IGES or BREP file. Faces that are connected with no other are sewn.
/// \param solid name or number, from 1, of the wanted one; empty: the file has one only
/// \throws InputError mesh.not_cad (its content is not of the kind its ending names),
/// mesh.empty_cad, mesh.several_solids, mesh.no_such_solid
[[nodiscard]] OcctPart read_occt(const std::filesystem::path& file, const std::string& solid);

}  // namespace meshwind
