/// The Cover planner: courses for a surface without an equation.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "winding/plan.h"
#include "winding/prove.h"
#include "winding/select.h"

namespace meshwind {

/// The whole plan is shown to the machine so many times at most. Of 14 plans of five tees one
/// needed a second attempt and none more; of those that need more than a few, each costs minutes.
inline constexpr int kMostAttempts = 5;

struct CoverOptions {
    Tow tow;
    TurnRule turn;  ///< friction and band are taken from `tow`
    FreeFibreRule free_fibre;
    SelectOptions select;
    int fibres = 1;                     ///< that the plan may take, >= 1
    std::optional<double> angle_rad{};  ///< wanted winding angle (wound_angle.h)
    std::uint64_t seed = 1;
    int effort = 1;                ///< how long courses are annealed, as a multiple
    int candidates = 16000;        ///< tried over the whole surface
    int rounds = 3;                ///< of further candidates aimed at what is not reached yet
    int aimed_candidates = 4000;   ///< in each such round
    int scarce_candidates = 8000;  ///< tried near courses that go where few can be wound
    AskMachine accept;  ///< asked of every course, between half turns, before it enters the plan
    AskMachine wind;    ///< asked of every course that is to stay: its own program, wound again
    /// Asked of the whole plan: which of its pieces the machine cannot wind in their place. Those
    /// are replaced and the plan is made again, until it was asked kMostAttempts times; then the
    /// plan with the fewest of them stands.
    std::function<std::vector<std::size_t>(std::span<const Piece>)> refused;
    std::function<void(const char* step, double share)> progress;
};

/// Samples the wall, builds a library of admissible courses, aims further candidates at what no
/// course reaches, chooses, balances the rims, orders and joins by friction turns. \param obstacles
/// everything that the free fibre must not hit: mandrel with its extensions \return a plan; when
/// nothing is admissible its `failure` says why and `pieces` is empty
[[nodiscard]] Plan plan_cover(const Mandrel& mandrel, const RayQuery& obstacles,
                              const CoverOptions& options);

}  // namespace meshwind
