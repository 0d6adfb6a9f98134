/// The cover planner: plans courses on a free-form surface, one without an equation.
#pragma once

#include <optional>

#include "core/run_context.h"
#include "winding/cover/library.h"
#include "winding/cover/select_courses.h"
#include "winding/laminate/stage_ask.h"
#include "winding/plan/figures.h"
#include "winding/plan/windability.h"

namespace meshwind {

/// Largest number of times that the machine winds the whole plan on trial. One of 14 plans of five
/// tees needed a second attempt and none more; where more than a few are needed, each costs
/// minutes.
inline constexpr int kMaxAttempts = 5;

struct CoverOptions {
    Tow tow;
    CourseTurns turns;  ///< friction and band of the rule are taken from `tow`
    FreeFibreRule free_fibre;
    SelectOptions select;
    const StageAsk* stage = nullptr;    ///< a stage of a wall, with the layers that places lack
    int fibres = 1;                     ///< number that the plan may take, >= 1
    std::optional<double> angle_rad{};  ///< wanted winding angle (wound_angle.h)
    RunContext context{};               ///< `effort`: how long courses are annealed
    double most_bare = kMaxBelow;       ///< largest share of the wall in reach that may lack layers
    double least_covered = 0.0;         ///< of the wall in reach; below it a plan fails, not wound
    double least_joined = 0.0;          ///< of the wall; so it does where fibres join less of it
    int candidates = 16000;             ///< tried over the whole surface
    int rounds = 3;                     ///< of further candidates aimed at what is not reached yet
    int aimed_candidates = 4000;        ///< in each such round
    int scarce_candidates = 8000;       ///< tried near courses that go where few can be wound
};

/// Samples the wall, builds a library of admissible courses, aims further candidates at places that
/// no course reaches, chooses courses, balances them at the rims, orders them and joins them by
/// friction turns.
/// \param obstacles everything that the free fibre must not hit: mandrel with its extensions
/// \param machine follows every course, between half turns, before it enters the plan; winds alone
/// every course that is to stay; then winds the whole plan. Pieces refused there are replaced and
/// the plan is made again, at most kMaxAttempts times; then the plan with the fewest refused pieces
/// is taken. Null: only a free length is asked for.
/// \return a plan; when nothing is admissible its `failure` says why and `pieces` is empty
[[nodiscard]] TriedPlan plan_cover(const Mandrel& mandrel, const RayQuery& obstacles,
                                   const CoverOptions& options,
                                   const Windability* machine = nullptr);

}  // namespace meshwind
