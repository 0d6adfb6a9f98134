/// Unions, cuts and fillets that say whether they came out well.
#pragma once

#include <optional>
#include <vector>

#include <TopoDS_Edge.hxx>
#include <TopoDS_Shape.hxx>

namespace cad_part {

struct Union {
    TopoDS_Shape shape;
    std::vector<TopoDS_Edge> crossings;  ///< where surfaces of the two meet
};

/// None where the kernel fails or the result is not one valid solid.
[[nodiscard]] std::optional<Union> united(const TopoDS_Shape& shape,
                                          const std::vector<TopoDS_Shape>& with);

[[nodiscard]] std::optional<TopoDS_Shape> common_of(const TopoDS_Shape& a, const TopoDS_Shape& b);

/// \param solids that are left; 0: any number from one on
[[nodiscard]] std::optional<TopoDS_Shape> without(const TopoDS_Shape& shape,
                                                  const std::vector<TopoDS_Shape>& tools,
                                                  int solids = 1);

/// None where the kernel finds no such fillet, or one that takes away what it should fill.
[[nodiscard]] std::optional<TopoDS_Shape> filleted(const TopoDS_Shape& shape,
                                                   const std::vector<TopoDS_Edge>& edges,
                                                   double radius_mm);

[[nodiscard]] double volume_mm3(const TopoDS_Shape& shape);

}  // namespace cad_part
