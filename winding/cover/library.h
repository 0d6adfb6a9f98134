/// The library of admissible courses: traces candidates and judges which can be wound at all.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geodesic/lifted_wall.h"
#include "geodesic/slip_and_bridging.h"
#include "geodesic/trace.h"
#include "mesh/mandrel.h"
#include "mesh/ray_query.h"
#include "winding/laminate/footprint.h"
#include "winding/plan/course.h"
#include "winding/plan/course_fault.h"
#include "winding/plan/free_fibre.h"
#include "winding/plan/tow.h"
#include "winding/turn/course_turns.h"

namespace meshwind {

/// Rules by which candidates are judged; references must outlive it.
struct CourseRules {
    const Mandrel& mandrel;
    const RayQuery& obstacles;
    const FootprintFinder& footprints;
    Tow tow;
    CourseTurns turns;
    FreeFibreRule free_fibre;
    double max_half_length_mm =
        1e4;  ///< a candidate that meets no rim within this circles for ever
    std::optional<double> angle_rad{};   ///< wanted winding angle
    const LiftedWall* lifted = nullptr;  ///< of the mandrel's surface, or null
};

/// Length of half a candidate beyond which it circles without meeting a rim, on this surface.
[[nodiscard]] double max_half_length_mm(const Surface& surface);

/// The unit tangent along which a candidate leaves its seed.
[[nodiscard]] Eigen::Vector3d direction_of(const Surface& surface, const Candidate& candidate);

/// The angle of a candidate that leaves its seed along `tangent`, where the surface's normal is
/// `normal`.
[[nodiscard]] double direction_angle(const Eigen::Vector3d& normal, const Eigen::Vector3d& tangent);

/// A direction for a candidate through a place. With a wanted winding angle, two in three draws
/// have it, by one hand or the other, where the wall is like a pipe; else any direction.
/// \param unit, choice drawn from [0, 1)
[[nodiscard]] double draw_direction_rad(const CourseRules& rules, const SurfacePoint& place,
                                        double unit, double choice);

/// The whole path of a candidate, as far as it can be followed either way.
[[nodiscard]] SurfacePath trace_both_ways(const CourseRules& rules, const Candidate& candidate,
                                          TraceMethod method = TraceMethod::Patches);

/// Follows a candidate on the curved patches and measures its slip. On CandidateFault::None
/// `member` holds its ends and length, and `followed` the course; on others both are unchanged.
[[nodiscard]] CandidateFault follow_course(const CourseRules& rules, const Candidate& candidate,
                                           LibraryCourse& member, TracedCourse& followed);

/// True when a free length can be found all along a course, in one direction of travel.
[[nodiscard]] bool is_windable(const CourseRules& rules, const TracedCourse& course, bool backward);

/// Judges a candidate by all rules. On CandidateFault::None `member` is filled, on others it is
/// unchanged.
[[nodiscard]] CandidateFault judge(const CourseRules& rules, const Candidate& candidate,
                                   FootprintFinder::Scratch& scratch, LibraryCourse& member);

/// Judges a candidate by the walk alone: as draw_sketch(), but without a footprint. Where fibre
/// turns on pins the path is one beside it that ends at pins.
[[nodiscard]] CandidateFault draw_path(const CourseRules& rules, const Candidate& candidate,
                                       DraftCourse& sketch);

/// Judges a candidate by the walk: ends, turns and bridges. On CandidateFault::None `sketch` is
/// filled, on others it is unusable. Slip is not measured: the candidate is steered within the
/// friction.
[[nodiscard]] CandidateFault draw_sketch(const CourseRules& rules, const Candidate& candidate,
                                         FootprintFinder::Scratch& scratch, DraftCourse& sketch);

/// True when a free length can be found about every `step_mm` of a path, and carried from each
/// place to the next. \param path in the direction of travel \param string over it
[[nodiscard]] bool is_windable(const CourseRules& rules, const SurfacePath& path,
                               const TautString& string, double step_mm);

/// Distance of the places at which a sketch is checked.
inline constexpr double kSketchStep_mm = 12.0;

/// How candidates are judged: by the walk alone, or where that admits them by all rules as well.
enum class Judging { Sketches, Courses };

/// Candidates judged in parallel. Members in the order of the candidates, whatever the threads.
struct LibraryPart {
    std::vector<LibraryCourse> members;
    std::vector<CandidateFault> outcome;  ///< per candidate
};
[[nodiscard]] LibraryPart build_library(const CourseRules& rules,
                                        std::span<const Candidate> candidates,
                                        Judging judging = Judging::Sketches);

}  // namespace meshwind
