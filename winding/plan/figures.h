/// Figures of a plan: coverage, winding angles, places in the order, planning effort.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "winding/plan/course_fault.h"

namespace meshwind {

/// How the wall is covered, measured on the coverage samples.
struct Coverage {
    double fraction = 0.0;   ///< share of the wall under at least one layer
    double reachable = 0.0;  ///< share passed by courses that hold
    /// Of covers: share passed by courses that hold and that the plan's fibres can join.
    std::optional<double> joinable{};
    double mean_layers = 0.0;
    int max_layers = 0;
    int p1_layers = 0;  ///< first percentile: 99 % of the wall in reach has at least this many
    double cv = 0.0;    ///< standard deviation of the layers over their mean
    /// The same where a pattern is regular, of the layers averaged over a tow width.
    std::optional<double> regular_cv{};
    std::optional<double> thinnest_layers{};  ///< so averaged, and where it is regular
    std::optional<double> thickest_layers{};
};

/// Use of a plan's fibre.
struct FibreUse {
    /// All fibre divided by that of the layers asked for without a gap, an overlap or a turn; at
    /// best 1.
    double factor = 0.0;
    double turn_share = 0.0;  ///< share of all fibre that lies in turns and is cut off
};

/// Share of the wall that a pattern must cover for `auto` to take it, and of what is in reach that
/// a plan comes near to winding it.
inline constexpr double kCoveredShare = 0.9;

/// Share of a wall in reach that may be thinner than asked for.
inline constexpr double kMaxBelow = 0.01;

/// Bare wall with the rule that keeps it bare.
struct Uncovered {
    std::int32_t region = -1;
    double area_mm2 = 0.0;
    std::string reason;  ///< the rule, and of how many courses it is the reason
    std::string rule;
};

/// Coverage in reach if one rule were relaxed.
struct RelaxedRule {
    enum class Rule { Friction, Bridging, Extension, Pins } rule = Rule::Friction;
    double factor = 1.0;     ///< on the rule's number; 1 of turns on pins in place of friction
    double reachable = 0.0;  ///< share of the wall
};

/// Winding angles of many courses over pipes, by length of fibre.
struct WoundAngles {
    double measured_mm = 0.0;  ///< over pipes; 0 where the wall has none
    double mean_rad = 0.0;
    std::optional<double> wish_rad{};  ///< wanted winding angle, if any
    double rms_off_rad = 0.0;          ///< from the wish
    double off_share = 0.0;  ///< of the fibre over pipes; from 10 degrees off on all counts
};

/// Where in the order the fibre of each kind lies: 0 first, 1 last, 0.5 where the order does not
/// matter. 0.5 where there is none.
struct Places {
    double junction = 0.5;
    double hoop = 0.5;
};

/// Effort of the planning; for reports.
struct PlanEffort {
    std::uint64_t seed = 0;
    double effort = 0.0;  ///< asked for
    std::int64_t candidates = 0;
    std::array<std::int64_t, kCandidateFaults> refusals{};
    std::int64_t proposals = 0;    ///< weighed while the courses were annealed
    std::int64_t taken = 0;        ///< of these
    int courses_out_of_reach = 0;  ///< chosen, but no fibre joins them; left out
    int turns_refused = 0;         ///< in the order, which the machine cannot follow
    int rejected_courses = 0;      ///< refused by the measured slip or by the machine
    std::array<std::int64_t, kRejections> rejections{};  ///< members of the library, by reason
};

}  // namespace meshwind
