/// CAD files as Open CASCADE reads them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <TopoDS_Shape.hxx>
#include <TopoDS_TShape.hxx>

namespace meshwind {

/// "#rrggbb" of faces that have one, wherever they stand.
using FaceColours = std::map<const TopoDS_TShape*, std::string>;

struct OcctPart {
    TopoDS_Shape shape;  ///< in mm
    double unit_mm = 1.0;
    int sewn_edges = 0;
    FaceColours colours{};  ///< of STEP files
};

/// Reads a STEP, IGES or BREP file. Faces that hang together with no other are sewn.
/// \param solid name or number, from 1, of the one that is meant; empty: the file has one only
/// \throws InputError mesh.not_cad (nothing of the kind that the ending promises), mesh.empty_cad,
/// mesh.several_solids, mesh.no_such_solid
[[nodiscard]] OcctPart read_occt(const std::filesystem::path& file, const std::string& solid);

}  // namespace meshwind
