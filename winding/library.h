/// The library of admissible courses: what can be wound at all, before anything is chosen.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geodesic/measure.h"
#include "geodesic/trace.h"
#include "mesh/mandrel.h"
#include "mesh/ray_query.h"
#include "winding/footprint.h"
#include "winding/free_fibre.h"
#include "winding/turn.h"

namespace meshwind {

struct Tow {
    double width_mm = 6.0;
    double thickness_mm = 0.25;
    double friction = 0.2;
    double bridging_tolerance_mm = 0.5;
};

/// Why a candidate is not admissible, in the order of the checks.
enum class Refusal : std::uint8_t { None, NoRim, NotTurnable, Bridging, Slips, NotWindable };
inline constexpr std::size_t kRefusals = 6;

/// Words for a report: "reaches no rim", ...
[[nodiscard]] const char* name_of(Refusal refusal);

/// A path by what determines it: traced both ways from a seed until it meets a rim.
struct Candidate {
    SurfacePoint seed;
    double angle_rad =
        0.0;  ///< direction in the tangent plane, from a fixed but arbitrary reference
    double slip_ratio = 0.0;  ///< steering where the surface is convex along the path
};

/// An admissible course: from end 0 to end 1, each over a rim.
struct Member {
    Candidate candidate;
    std::array<RimCrossing, 2> end;
    bool windable_forward = false;  ///< from end 0 to end 1
    bool windable_backward = false;
    double length_mm = 0.0;
    std::vector<std::int32_t> footprint;  ///< coverage samples
};

/// All that judging a candidate needs; references must outlive it.
struct CourseRules {
    const Mandrel& mandrel;
    const RayQuery& obstacles;
    const FootprintFinder& footprints;
    Tow tow;
    TurnRule turn;
    FreeFibreRule free_fibre;
    double max_half_length_mm =
        1e4;  ///< a candidate that meets no rim within this circles for ever
};

/// The angle of a candidate that leaves its seed along `tangent`, where the surface's normal is
/// `normal`.
[[nodiscard]] double direction_angle(const Eigen::Vector3d& normal, const Eigen::Vector3d& tangent);

/// The whole path of a candidate from rim to rim; empty when an end reaches no rim.
[[nodiscard]] SurfacePath trace_both_ways(const CourseRules& rules, const Candidate& candidate);

/// Judges a candidate. On Refusal::None `member` is filled, on others it is unchanged.
[[nodiscard]] Refusal judge(const CourseRules& rules, const Candidate& candidate,
                            FootprintFinder::Scratch& scratch, Member& member);

/// Candidates judged in parallel. Members in the order of the candidates, whatever the threads.
struct LibraryPart {
    std::vector<Member> members;
    std::vector<Refusal> outcome;  ///< per candidate
};
[[nodiscard]] LibraryPart build_library(const CourseRules& rules,
                                        std::span<const Candidate> candidates);

/// Where the fibre of a station really is and leaves to: on the taut string over the path.
struct StringPoint {
    Eigen::Vector3d position_mm;
    Eigen::Vector3d tangent;
};
[[nodiscard]] StringPoint string_point(const PathPoint& point, double gap_mm, double slope);

}  // namespace meshwind
