/// The library of admissible courses: what can be wound at all, before anything is chosen.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
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
    double slip_ratio = 0.0;   ///< steering where the surface is convex along the path
    double more_behind = 0.0;  ///< added to it from the seed back to end 0
};

/// An admissible course: from end 0 to end 1, each over a rim.
struct Member {
    Candidate candidate;
    std::array<RimCrossing, 2> end;
    bool windable_forward = false;  ///< from end 0 to end 1
    bool windable_backward = false;
    double length_mm = 0.0;
    double off_angle_mm = 0.0;            ///< length off the wanted winding angle (wound_angle.h)
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
    std::optional<double> angle_rad{};  ///< wanted winding angle
};

/// The unit tangent along which a candidate leaves its seed.
[[nodiscard]] Eigen::Vector3d direction_of(const Surface& surface, const Candidate& candidate);

/// The angle of a candidate that leaves its seed along `tangent`, where the surface's normal is
/// `normal`.
[[nodiscard]] double direction_angle(const Eigen::Vector3d& normal, const Eigen::Vector3d& tangent);

/// A direction for a candidate through a place: with a wanted winding angle two in three draws lead
/// there, one hand or the other, where the wall is like a pipe; else any direction.
/// \param unit, choice drawn from [0, 1)
[[nodiscard]] double draw_direction_rad(const CourseRules& rules, const SurfacePoint& place,
                                        double unit, double choice);

/// The whole path of a candidate, as far as it can be followed either way.
[[nodiscard]] SurfacePath trace_both_ways(const CourseRules& rules, const Candidate& candidate,
                                          TraceMethod method = TraceMethod::Patches);

/// A finished course, from end 0 to end 1.
struct FollowedCourse {
    SurfacePath path;
    TautString string;
    SlipMeasure slip;
};

/// Follows a candidate on the curved patches and measures its slip. On Refusal::None `member` holds
/// its ends and length, and `followed` the course; on others both are unchanged.
[[nodiscard]] Refusal follow_course(const CourseRules& rules, const Candidate& candidate,
                                    Member& member, FollowedCourse& followed);

/// True when a free length can be found all along a course, in one direction of travel.
[[nodiscard]] bool is_windable(const CourseRules& rules, const FollowedCourse& course,
                               bool backward);

/// Judges a candidate by all rules. On Refusal::None `member` is filled, on others it is unchanged.
[[nodiscard]] Refusal judge(const CourseRules& rules, const Candidate& candidate,
                            FootprintFinder::Scratch& scratch, Member& member);

/// A candidate as the walk over the facets sees it: a first opinion, many times as fast as judge().
struct Sketch {
    Member course;     ///< windable neither way until that is looked into
    SurfacePath path;  ///< from end 0 to end 1
};

/// Judges a candidate by the walk alone: as draw_sketch(), but without a footprint.
[[nodiscard]] Refusal draw_path(const CourseRules& rules, const Candidate& candidate,
                                Sketch& sketch);

/// Judges a candidate by the walk: ends, turns and bridges. On Refusal::None `sketch` is filled, on
/// others it is of no use. Slip is not measured: the candidate is steered within the friction.
[[nodiscard]] Refusal draw_sketch(const CourseRules& rules, const Candidate& candidate,
                                  FootprintFinder::Scratch& scratch, Sketch& sketch);

/// True when a free length can be found about every `step_mm` of a path, and carried from each
/// place to the next. \param path in the direction of travel \param string over it
[[nodiscard]] bool is_windable(const CourseRules& rules, const SurfacePath& path,
                               const TautString& string, double step_mm);

/// Distance of the places at which a sketch is looked into.
inline constexpr double kSketchStep_mm = 12.0;

/// How candidates are judged: by the walk alone, or where that admits them by all rules as well.
enum class Judging { Sketches, Courses };

/// Candidates judged in parallel. Members in the order of the candidates, whatever the threads.
struct LibraryPart {
    std::vector<Member> members;
    std::vector<Refusal> outcome;  ///< per candidate
};
[[nodiscard]] LibraryPart build_library(const CourseRules& rules,
                                        std::span<const Candidate> candidates,
                                        Judging judging = Judging::Sketches);

/// Where the fibre of a station really is and leaves to: on the taut string over the path.
struct StringPoint {
    Eigen::Vector3d position_mm;
    Eigen::Vector3d tangent;
};
[[nodiscard]] StringPoint string_point(const PathPoint& point, double gap_mm, double slope);

}  // namespace meshwind
