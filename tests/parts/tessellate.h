/// The mesh of a shape as a modeller exports it, and where it is put.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <gp_Trsf.hxx>

#include "part.h"

namespace cad_part {

struct ExportOptions {
    double linear_mm = 0.1;  ///< or a share of the edges' size
    bool relative = false;
    double angular_rad = 0.3;
    bool seams = false;     ///< faces do not meet to the last bit
    bool inverted = false;  ///< triangles are seen from inside
    bool moved = false;
    gp_Trsf motion{};
    std::string_view unit = "mm";
    double unit_mm = 1.0;  ///< length of a unit of the file
};

[[nodiscard]] ExportOptions draw_export(Random& random);

struct Triangle {
    std::array<gp_Pnt, 3> corner;
    int face = 0;
};

/// In mm, where the part was drawn; outside seen counter-clockwise. Empty where a face has no mesh.
[[nodiscard]] std::vector<Triangle> tessellated(const Built& built, const ExportOptions& options);

/// Whether each edge has its twin, corners compared exactly.
[[nodiscard]] bool watertight(const std::vector<Triangle>& triangles);

/// Without the end faces of the legs.
[[nodiscard]] std::vector<Triangle> skin_of(const Part& part,
                                            const std::vector<Triangle>& triangles);

[[nodiscard]] std::vector<Triangle> without_face(const std::vector<Triangle>& triangles,
                                                 const MissingFace& face);

/// Binary STL in the file's units. \return whether it is written
[[nodiscard]] bool write_stl(const std::string& file, const std::vector<Triangle>& triangles,
                             const ExportOptions& options, Random& random);

/// The exact faces in the file's units, where the triangles are. \return whether it is written
[[nodiscard]] bool write_step(const std::string& file, const TopoDS_Shape& shape,
                              const ExportOptions& options);

}  // namespace cad_part
