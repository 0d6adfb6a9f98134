/// The pattern planner: regular windings of a body of revolution, closed exactly.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "core/run_context.h"
#include "core/units.h"
#include "mesh/mandrel.h"
#include "mesh/revolution/revolution.h"
#include "winding/plan/course_fault.h"
#include "winding/plan/piece.h"
#include "winding/plan/plan.h"
#include "winding/plan/tow.h"
#include "winding/revolution/meridian_path.h"
#include "winding/revolution/pattern_begin.h"
#include "winding/revolution/pattern_constraints.h"
#include "winding/revolution/rim_turns.h"
#include "winding/turn/turn.h"

namespace meshwind {

enum class PatternKind { Helical, Polar, Hoop };

struct PatternOptions {
    PatternKind kind = PatternKind::Helical;
    double angle_rad = rad_from_deg(45.0);  ///< helical: at the widest place
    double layers = 1.0;  ///< covers; each lays a ply of either hand, of hoops one
    Tow tow{};
    TurnRule turn{};                              ///< friction and band are taken from `tow`
    PatternConstraints wish{};                    ///< helical, polar
    RimTurnsMaker turns = friction_turns;         ///< helical, polar: how it turns over rims
    std::optional<LatticeConstraints> lattice{};  ///< helical: ribs instead of a closed wall
    /// Where hoops shall lie, a part that is nearly a cylinder; none: the cylinder at the widest
    /// place.
    std::optional<std::array<double, 2>> hoop_z_mm{};
    /// Fibre to go on with, by connecting passes (connecting_passes.h) or a turn; where that is not
    /// possible, Plan::cut_reason says why and the pattern begins anew.
    std::optional<FibreEnd> before{};
    double least_covered = 0.0;  ///< helical, polar: of the wall; a pattern below it is not laid
    /// Helical, polar: whether the machine winds the first circuits, of which the others are turned
    /// copies. A plan whose circuits it refuses fails, and is not measured. None: not asked.
    std::function<CourseFault(std::span<const Piece> circuits)> winds{};
    RunContext context{};  ///< its seed is that of the samples that coverage is measured on
};

/// Plans circuits that lead from the lower turn to the upper one and back. Each is the one before,
/// turned on by the same angle, so that after all of them the fibre is back where it began and the
/// bands lie side by side.
///  - Where the body narrows to r = c the path turns by itself (Clairaut); such ends have no dwell,
///    and the winding angle gives way by the little that closes the pattern.
///  - Where it runs over a rim it turns as rim_turns.h has it: by friction on the extension, where
///    it dwells for as long as closing takes, or on pins, where it runs behind as many as closing
///    takes, and their distance from the rim makes up the rest.
///  - Polar: the band touches the opening, or the pole, of either end; where these are of different
///    sizes it is steered with a constant slip ratio from one to the other.
///  - Lattices: after each series the fibre dwells a little longer, by the offset of its bands; all
///    series are wound once for each ply.
///  - Hoop: the cylinder at the widest place, wound side by side, a ply for each cover, up and down
///    in turn (hoop_path.h).
/// \return a plan; where nothing can be wound `failure` says why, with numbers
[[nodiscard]] Plan plan_pattern(const Mandrel& mandrel, const BodyOfRevolution& body,
                                const PatternOptions& options);

}  // namespace meshwind
