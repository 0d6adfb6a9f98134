/// Regions of a file's surface: outer wall, end caps, bores and others.
#pragma once

#include <cstdint>
#include <string_view>

namespace meshwind {

enum class RegionKind { OuterWall, EndCap, Bore, Other };

/// "outer-wall", "end-cap", "bore", "other": the words of report.json.
[[nodiscard]] std::string_view name_of(RegionKind kind);

/// A piece of the file's surface bounded by feature edges.
struct Region {
    std::int32_t id = 0;
    RegionKind kind = RegionKind::Other;
    bool kept = false;  ///< part of the winding surface
    int triangles = 0;
    double area_mm2 = 0.0;
    double visible_fraction = 0.0;  ///< share of its area from which most of the outside is seen
};

}  // namespace meshwind
