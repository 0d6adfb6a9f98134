/// Start of a pattern that continues the fibre of the layer before.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "winding/plan/plan.h"
#include "winding/revolution/connecting_passes.h"
#include "winding/revolution/revolution_pieces.h"

namespace meshwind {

/// End of the fibre of the layer before, over a rim or along a parallel.
struct FibreEnd {
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();
    std::int32_t rim = -1;  ///< that it leaves over; -1: none
    bool in_air = false;    ///< there, on its way over a hollow rim (hollow_rim.h)
};

/// Fibre end of a plan, as its last course leaves it, before it runs out behind a hollow rim
/// (turn.h).
[[nodiscard]] FibreEnd fibre_end_of(const Plan& plan);

struct PatternBegin {
    std::size_t end = 0;       ///< of the body: the lower is 0
    double azimuth_rad = 0.0;  ///< about +Z, of the pattern's first station
    /// From the fibre's end to there, in order: passes, and turns where they have a rim.
    std::vector<LaidTurn> pieces;
    std::string cut_reason;  ///< empty, or in words why the fibre cannot be led on
};

/// Leads the fibre on: over the rim into the pattern, or by steered passes.
/// \param goal where the pattern may begin at either end
/// \param first its first station there when it begins at either end, any azimuth
[[nodiscard]] PatternBegin begin_after(const FibreEnd& before, const Meridian& meridian,
                                       const RevolutionPieces& pieces,
                                       const std::array<ConnectingGoal, 2>& goal,
                                       const std::array<MeridianStation, 2>& first,
                                       const TurnRule& rule);

}  // namespace meshwind
