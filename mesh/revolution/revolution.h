/// Detects mandrels that are bodies of revolution about their spindle, with their meridian.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/mandrel.h"
#include "mesh/revolution/meridian.h"
#include "mesh/revolution/profile_points.h"

namespace meshwind {

/// A body of revolution has no vertex farther than this from the surface of its meridian: enough
/// for errors of exports and facets (0.02 mm on a pipe of 50 mm), too little for an oval or a dent
/// that shows in a pattern.
inline constexpr double kRevolutionResidualMm = 0.5;

/// And than this share of its largest radius: an oval of 2 % is off by 1 %.
inline constexpr double kRevolutionResidualShare = 0.005;

enum class MeridianPartKind { Cylinder, Cone, Dome };

/// "cylinder", "cone", "dome": the words of report.json. A disc is a cone of 90 degrees.
[[nodiscard]] std::string_view name_of(MeridianPartKind kind);

/// A stretch of the meridian between creases and changes from straight to curved.
struct MeridianPart {
    MeridianPartKind kind = MeridianPartKind::Dome;  ///< Dome: anything curved
    double from_mm = 0.0;                            ///< arc length
    double to_mm = 0.0;
    double radius_mm = 0.0;  ///< mean over the arc length
    double slope_rad = 0.0;  ///< of a cone, half its angle; > 0 where it widens with the arc
};

struct BodyOfRevolution {
    Meridian meridian;         ///< from the lower end to the upper one, mandrel frame
    double residual_mm = 0.0;  ///< largest distance of a vertex from the surface of the meridian
    std::array<MeridianEnd, 2> end;
    std::vector<MeridianPart> parts;
};

struct RevolutionFinding {
    std::optional<BodyOfRevolution> body;
    std::string why_not;  ///< in words where there is none: "it has 3 rims, ..."
};

/// Compares the winding surface with the surface that its meridian sweeps about Z. It refuses more
/// than two rims, rims or normals off the spindle, holes, creases along the spindle, surfaces in
/// pieces, and a residual above the tolerances above. The meridian starts at the lower end, except
/// where outside would then lie on its left.
/// Accuracy: see fit_meridian; tests/mesh/revolution/revolution_test.cpp.
[[nodiscard]] RevolutionFinding find_revolution(const Surface& surface, std::span<const Rim> rims);
[[nodiscard]] RevolutionFinding find_revolution(const Mandrel& mandrel);

}  // namespace meshwind
