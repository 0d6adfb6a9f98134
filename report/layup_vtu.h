/// The winding surface with values per triangle, for ParaView and FreeCAD: VTK's XML unstructured
/// grid.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <variant>

#include <Eigen/Core>

namespace meshwind {

/// A number or a direction per triangle under the name that the viewer shows; units belong in the
/// name.
struct CellArray {
    std::string name;  ///< e.g. "thickness_mm"
    std::variant<std::span<const double>, std::span<const std::int32_t>,
                 std::span<const Eigen::Vector3d>>
        values;
};

/// Text of a .vtu file (ASCII). Positions are written to 1e-6 mm, directions to 1e-4, numbers so
/// that they read back exactly. \param triangles m x 3 indices into `points_mm` \param cells each
/// with m finite values
[[nodiscard]] std::string layup_vtu(std::span<const Eigen::Vector3d> points_mm,
                                    std::span<const std::array<std::int32_t, 3>> triangles,
                                    std::span<const CellArray> cells);

}  // namespace meshwind
