/// Turns of a pattern's fibre beyond the rims of its body: a class for each kind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mesh/rim.h"
#include "winding/plan/assemble.h"
#include "winding/plan/tow.h"
#include "winding/plan/turns.h"
#include "winding/revolution/pattern_constraints.h"

namespace meshwind {

/// An end of the body at which passes run over its rim.
struct RimEnd {
    std::size_t end = 0;  ///< of the body: the lower is 0, the upper 1
    const Rim& rim;       ///< lives as long as the turns
    RimCrossing crossing;
    double angle_rad = 0.0;  ///< of the pattern, at the widest place

    /// "lower"
    [[nodiscard]] std::string name() const { return end == 0 ? "lower" : "upper"; }
};

/// The planner adds the ends, finds the pattern, has it placed, and then asks for each turn. Fibre
/// that leads on from the layer before (pattern_begin.h) turns by friction whatever the pattern
/// does.
class RimTurns {
public:
    virtual ~RimTurns() = default;

    /// Whether passes go straight over hollow rims onto the extension; else they stay on the wall.
    [[nodiscard]] virtual bool lifts_over_hollow_rims() const { return true; }

    /// \return empty, or in words why it cannot be turned at that end
    [[nodiscard]] virtual std::string add(const RimEnd& end) = 0;

    /// Where no end was added, since the fibre turns by itself at both: empty, or in words why
    /// nothing can be wound. \param angle_rad at the widest place
    [[nodiscard]] virtual std::string why_no_ends(double angle_rad) const;

    /// Angle about the axis, >= 0, of a turn without dwell. \pre the end was added, as below
    [[nodiscard]] virtual double shortest_rad(std::size_t end) const = 0;

    /// Least dwell of a turn, whatever the pattern has.
    [[nodiscard]] virtual double least_dwell_rad() const = 0;

    using Find = std::function<FoundPattern(const PatternConstraints&)>;
    /// The pattern that these turns can close.
    /// \param find the best one for a wish, whose least and most dwell are at each end
    [[nodiscard]] virtual FoundPattern find(const PatternConstraints& wish, const Find& find);

    /// Fits the turns to the pattern that was found. \param series of a lattice, else 1
    /// \return empty, or in words why they cannot be
    [[nodiscard]] virtual std::string place(const Pattern& pattern, std::int64_t series);

    /// The turn from where a course leaves over the rim to where the next one comes back.
    [[nodiscard]] virtual LaidTurn turn(std::size_t end, const RimCrossing& from,
                                        const RimCrossing& to) = 0;

    /// Rings of pins that the turns so far need.
    [[nodiscard]] virtual std::vector<PinRing> pins() const { return {}; }
};

/// Makes the turns of a plan. \param extension_mm axial length of the extension
using RimTurnsMaker = std::function<std::unique_ptr<RimTurns>(const Tow& tow, double extension_mm)>;

/// Turns by friction on the extension (turn.h).
[[nodiscard]] std::unique_ptr<RimTurns> friction_turns(const Tow& tow, double extension_mm);

/// No turns over rims: the fibre turns on the wall itself, about poles.
[[nodiscard]] std::unique_ptr<RimTurns> no_rim_turns();

}  // namespace meshwind
