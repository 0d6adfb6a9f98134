/// Finds closed circuits over a body of revolution: the pass that they repeat, and their pattern.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "mesh/mandrel.h"
#include "mesh/revolution/revolution.h"
#include "winding/plan/details.h"
#include "winding/revolution/meridian_path.h"
#include "winding/revolution/pattern_plan.h"
#include "winding/revolution/revolution_pieces.h"
#include "winding/revolution/rim_turns.h"
#include "winding/turn/turn.h"

namespace meshwind {

/// Input of a pattern plan; references must outlive it.
struct PatternTask {
    const Mandrel& mandrel;
    const BodyOfRevolution& body;
    const PatternOptions& options;
    const TurnRule& rule;
    const RevolutionPieces& pieces;
    double widest_mm = 0.0;  ///< arc length of the widest place
    double widest_radius_mm = 0.0;
};

/// A pass on the wall, from the lower end to the upper one.
struct WallPass {
    double angle_rad = 0.0;  ///< at the widest place
    HalfSlips slip{};
    MeridianPass path{};

    /// Whether it comes to the rim of an end and dwells there; else it turns by itself. The lower
    /// end is 0, the upper 1.
    [[nodiscard]] bool dwells(std::size_t end) const {
        return (end == 0 ? path.lower : path.upper) == MeridianStop::End;
    }

    /// r cos(angle) where bands lie farthest apart: without steering at the widest place.
    [[nodiscard]] double sparsest_mm(double widest_radius_mm) const {
        double sparsest = widest_radius_mm * std::cos(angle_rad);
        for (const MeridianStation& at : path.stations) {
            sparsest = std::max(sparsest, at.place.radius_mm * std::cos(at.angle_rad));
        }
        return sparsest;
    }
};

struct ClosedCircuits {
    WallPass wall{};
    MeridianPass laid{};  ///< as fibre lies between two turns: straight over hollow rims
    Pattern pattern{};
    std::optional<LaidLattice> lattice{};
    std::string failure{};  ///< not empty: why nothing can be wound, with numbers
};

/// Aims a pass at both ends of the body, leads it over hollow rims, and finds the pattern whose
/// bands close the wall. Circuits that dwell at an end close by their dwell, others by another
/// winding angle. \param turns the ends are added to them, and they are placed for the pattern
[[nodiscard]] ClosedCircuits close_circuits(const PatternTask& task, RimTurns& turns);

}  // namespace meshwind
