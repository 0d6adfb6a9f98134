/// Detects mandrels that are tubes: round all along a line that may bend.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/mandrel.h"
#include "mesh/tube/centre_line.h"

namespace meshwind {

/// A tube has no vertex farther than this from its surface, nor than this share of its radius: the
/// limits of a body of revolution (mesh/revolution/revolution.h), for the same reasons.
inline constexpr double kTubeResidualMm = 0.5;
inline constexpr double kTubeResidualShare = 0.005;

enum class TubePartKind { Straight, Bend, Curve };

/// "straight", "bend", "curve": the words of report.json.
[[nodiscard]] std::string_view name_of(TubePartKind kind);

/// A stretch of the centre line.
struct TubePart {
    TubePartKind kind = TubePartKind::Straight;  ///< Curve: neither a line nor an arc of a circle
    double from_mm = 0.0;                        ///< arc lengths
    double to_mm = 0.0;
    double bend_radius_mm = 0.0;  ///< of a bend's centre line
    double angle_rad = 0.0;       ///< how far the tangent turns
};

/// Radius of a tube at a place along its line.
struct TubeRadius {
    double arc_mm = 0.0;
    double radius_mm = 0.0;
};

struct Tube {
    CentreLine line;  ///< from the centre of rim[0] to that of rim[1], mandrel frame
    std::vector<TubeRadius>
        radius;                   ///< n >= 1 by ascending arc, linear in between; n = 1: constant
    std::vector<TubePart> parts;  ///< n >= 1, without gaps
    std::array<std::int32_t, 2> rim{-1, -1};
    std::array<double, 2> lean_rad{};  ///< between each rim's axis and the line there, >= 0
    double residual_mm = 0.0;          ///< largest distance of a vertex from the tube, square to it

    /// \param arc_mm any: that of the end beyond it
    [[nodiscard]] double radius_at(double arc_mm) const;
};

struct TubeFinding {
    std::optional<Tube> tube;
    std::string why_not;  ///< in words where there is none: "it has 3 rims, a tube has two"
};

/// Finds a line about which the winding surface is round. Circles are fitted to sections square to
/// the line and the line is drawn through their centres, until it converges. Where it is made of
/// straight stretches and arcs of circles with one radius all along, it is refitted as such; the
/// first place of `parts` is then exact. The tube runs from the rim of lower id. The `reference` of
/// the line lies in the plane of the first bend, away from its centre. Surfaces without two rims,
/// with holes or handles, in pieces, or with a residual above the limits above are refused.
/// Accuracy: docs/geometry.md, "Tubes"; tests/mesh/tube/tube_test.cpp.
[[nodiscard]] TubeFinding find_tube(const Mandrel& mandrel);

}  // namespace meshwind
