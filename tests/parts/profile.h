/// Solids of revolution from their outline.
#pragma once

#include <optional>
#include <vector>

#include <TopoDS_Shape.hxx>
#include <gp_Ax2.hxx>

namespace cad_part {

/// An outline runs along this ellipse, whose middle is on the axis.
struct Dome {
    double centre_mm = 0.0;  ///< along the axis
    double radius_mm = 0.0;  ///< at the equator
    double height_mm = 0.0;  ///< signed: below 0 for a dome that opens upwards; <= radius
};

struct Corner {
    double radius_mm = 0.0;
    double along_mm = 0.0;       ///< along the axis
    double round_mm = 0.0;       ///< of the arc in place of the corner; 0: sharp
    std::optional<Dome> dome{};  ///< the way from the corner before; none: straight
};

/// The same outline for an axis the other way round. \pre no domes
[[nodiscard]] std::vector<Corner> mirrored(const std::vector<Corner>& corners);

[[nodiscard]] std::vector<Corner> shifted(const std::vector<Corner>& corners, double along_mm);

/// The outline is closed over the axis at its first and last corner; corners that repeat the one
/// before are left out. \throws Standard_Failure where there is no such solid
[[nodiscard]] TopoDS_Shape revolved(const gp_Ax2& frame, const std::vector<Corner>& corners);

}  // namespace cad_part
