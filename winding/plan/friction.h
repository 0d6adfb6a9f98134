/// Friction between fibre and wall: the largest slip ratio that holds.
#pragma once

#include "core/margins.h"

namespace meshwind {

/// Friction under one layer. It is made in one place (pipeline/job/job_friction.h) and carried by
/// Setup, Tow, TurnRule and VerifyRules; code that lays or judges fibre asks it for the limit.
///
/// A layer has one number. The closed forms of turns (winding/turn/turn.h) want one for a turn, and
/// steering with a constant slip ratio wants one for a pass. A law that varies along the path
/// therefore gives planners its least value on the layer, and `holds()` is asked with the station
/// only where single stations are judged: SlipOptions and the check `slip` of
/// postproc/verify/laid_checks.cpp, courses of a cover in winding/cover/library.cpp, and what the
/// blocks may add in pipeline/block_time.cpp.
class Friction {
public:
    /// \param ratio >= 0, |kg / kn|
    constexpr Friction(double ratio) : ratio_(ratio) {}

    /// The largest |slip ratio| that holds at all: verify judges the laid fibre by it.
    [[nodiscard]] constexpr double holds() const { return ratio_; }

    /// A share of the limit. \param part a stage's share (core/margins.h); negative: to the other
    /// side
    [[nodiscard]] constexpr double share(double part) const { return part * ratio_; }

    /// The share for planners; the rest is for the slip that the blocks of a program add.
    [[nodiscard]] constexpr Friction planned() const { return share(margin::kPlannedFriction); }

private:
    double ratio_;
};

}  // namespace meshwind
