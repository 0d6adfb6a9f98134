/// How long a controller takes that blends each block into the next by a parabola, as LinuxCNC does
/// where rotary axes turn.
#pragma once

#include <limits>
#include <vector>

#include "machines/machine.h"
#include "postproc/motion/block.h"

namespace meshwind {

/// What such a controller is set to.
struct BlendPlanner {
    bool stops = false;  ///< between blocks: G61
    /// How far a blend may leave a corner of X Y Z, mm: the P of G64; infinite: as far as it does.
    double corner_mm = std::numeric_limits<double>::infinity();
    double cycle_s = 1e-3;  ///< of its servo thread, > 0
};

/// Seconds per block, 0 for the first. The controller runs block after block from rest to rest and
/// begins the next one while it slows down in the one before, so that what the two do adds up; so
/// that the sum keeps to the axes' acceleration, each has half of it. No block is therefore faster
/// than it gets within its own length: a block of length L, of which the axes allow the
/// acceleration a, takes sqrt(2 L / a) at least, however many follow. Where the tolerance leaves a
/// blend so slow that stops are faster, it stops. Blocks of X Y Z alone are
/// looked ahead over and faster; here they count like the others.
/// Source: LinuxCNC 2.9, src/emc/tp: tpComputeBlendVelocity, tpCalculateTrapezoidalAccel,
/// tpDoParabolicBlending, tcGetTangentialMaxAccel; run cycle by cycle.
/// \pre machine has the axes of list
[[nodiscard]] std::vector<double> blend_times_s(const Machine& machine, const BlockList& list,
                                                const BlendPlanner& planner = {});

}  // namespace meshwind
