/// CAD files as Open CASCADE reads them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <TopoDS_Shape.hxx>

namespace meshwind {

struct OcctPart {
    TopoDS_Shape shape;  ///< in mm
    double unit_mm = 1.0;
    int sewn_edges = 0;
};

/// Reads a STEP, IGES or BREP file. Faces that hang together with no other are sewn.
/// \param solid name or number, from 1, of the one that is meant; empty: the file has one only
/// \throws InputError mesh.not_cad (nothing of the kind that the ending promises), mesh.empty_cad,
/// mesh.several_solids, mesh.no_such_solid
[[nodiscard]] OcctPart read_occt(const std::filesystem::path& file, const std::string& solid);

}  // namespace meshwind
