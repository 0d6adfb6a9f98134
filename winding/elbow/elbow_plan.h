/// The elbow planner: winds a bend by helices of both hands as one continuous fibre. The bend has a
/// straight leg on either side or none.
#pragma once

#include <cstdint>
#include <optional>

#include "core/run_context.h"
#include "mesh/mandrel.h"
#include "mesh/tube/tube.h"
#include "winding/plan/plan.h"
#include "winding/plan/tow.h"
#include "winding/turn/turn.h"

namespace meshwind {

struct ElbowPlanOptions {
    /// To the tube's axis at the outer equator. None: the whole degree that takes the least fibre
    /// among those whose legs are closed and whose turns hold.
    std::optional<double> angle_rad{};
    double layers = 1.0;  ///< covers; each lays a ply of either hand where they are fewest
    Tow tow{};
    TurnRule turn{};       ///< friction and band are taken from `tow`
    RunContext context{};  ///< its seed is that of the samples that coverage is measured on
    /// The mandrel has layers on the tube (mesh/tube/grown_tube.h): stations are moved onto the
    /// mesh.
    bool on_layers = false;
};

/// Joins M lines of either hand (elbow_lines.h), mirror images in the plane of the bend: up the
/// tube by one hand, a turn on the extension, down by the other, a turn, and so on. Line i arrives
/// at the upper rim and leaves by the mirror image of line (p - i) mod M, which at the lower rim is
/// followed by line i + q - p: for gcd(q - p, M) = 1 that is one fibre through all lines. The p and
/// q with the least dwell are taken; each turn dwells by the distance of its two lines. On layers
/// the lines are those of the tube with their mean radius, moved out to the mesh square to the
/// tube's line. Source: the lines on the bend are dimovski_2018_elbows; that they are joined, and
/// the legs, are not. \return a plan; where nothing can be wound `failure` says why, with numbers
[[nodiscard]] Plan plan_elbow(const Mandrel& mandrel, const Tube& tube,
                              const ElbowPlanOptions& options);

}  // namespace meshwind
