/// Run time on a controller with parabolic blends between blocks, as LinuxCNC has where rotary axes
/// turn.
#pragma once

#include <limits>
#include <vector>

#include "machines/machine.h"
#include "postproc/motion/block.h"

namespace meshwind {

/// Settings of such a controller.
struct BlendPlanner {
    bool stops = false;  ///< between blocks: G61
    /// Largest distance of a blend from a corner of X Y Z, mm: the P of G64; infinite: no bound.
    double corner_mm = std::numeric_limits<double>::infinity();
    double cycle_s = 1e-3;  ///< of its servo thread, > 0
};

/// Seconds per block, 0 for the first. The controller runs block after block from rest to rest and
/// begins the next one while it slows down in the one before, so that their motions add up. Each
/// has half of the axes' acceleration, so that the sum keeps to it. No block is therefore faster
/// than it gets within its own length: a block of length L, along which the axes allow the
/// acceleration a, takes at least sqrt(2 L / a), however many follow. Where the tolerance leaves a
/// blend so slow that stops are faster, it stops. The controller looks ahead over blocks of X Y Z
/// alone and runs them faster; here they count like the others.
/// Source: LinuxCNC 2.9, src/emc/tp: tpComputeBlendVelocity, tpCalculateTrapezoidalAccel,
/// tpDoParabolicBlending, tcGetTangentialMaxAccel; run cycle by cycle.
/// \pre machine has the axes of list
[[nodiscard]] std::vector<double> blend_times_s(const Machine& machine, const BlockList& list,
                                                const BlendPlanner& planner = {});

}  // namespace meshwind
