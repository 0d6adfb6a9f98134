/// Chooses the courses of a cover, makes them even, and replaces those that do not hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "geodesic/lifted_wall.h"
#include "mesh/mandrel.h"
#include "mesh/ray_query.h"
#include "winding/cover/anneal_ground.h"
#include "winding/cover/cover.h"
#include "winding/cover/fibre_routes.h"
#include "winding/cover/library.h"
#include "winding/cover/prove_courses.h"
#include "winding/laminate/samples.h"
#include "winding/laminate/stage_ask.h"
#include "winding/plan/course.h"
#include "winding/plan/course_fault.h"
#include "winding/plan/windability.h"

namespace meshwind {

/// Task of a cover: what to cover, and by which rules. References must outlive it.
struct CoverTask {
    /// \param machine null: none
    CoverTask(const Mandrel& mandrel, const RayQuery& obstacles, const CoverOptions& options,
              const Windability* machine);
    CoverTask(const CoverTask&) = delete;
    CoverTask& operator=(const CoverTask&) = delete;

    /// Number of nodes, at which fibres are joined: two for each rim.
    [[nodiscard]] std::size_t nodes() const { return 2 * mandrel.rims.size(); }
    /// True in the last stage of a wall, in which thin places are filled.
    [[nodiscard]] bool is_last_stage() const { return stage.stages_left < 2; }
    void report_progress(const char* step, double share) const {
        options.context.report_progress(step, share);
    }

    const Mandrel& mandrel;
    const CoverOptions& options;
    const Windability* machine;
    StageAsk stage;
    SelectOptions select;  ///< with the targets of the stage
    CoverageSamples samples;
    FootprintFinder footprints;  ///< on these samples
    LiftedWall lifted;
    CourseRules rules;
    CourseProver prover;
};

/// Routes and reach of the plan's fibres.
struct FibreReach {
    PlanRoutes routes;
    std::vector<char> joinable;  ///< per sample: in reach of the fibres
};

/// The courses of a plan, not in order.
struct PlanCourses {
    std::vector<PlacedCourse> placed;
    std::vector<std::vector<DirectedCourse>>
        spare_links;               ///< per link: courses to replace it, the best last
    std::uint64_t annealings = 0;  ///< so far
    /// What further courses have to be turned to and from (can_be_turned()); none: not looked at.
    std::vector<PlacedCourse> turned_with{};
};

/// Keeps the courses that hold, and adds those to begin with (select_courses.h).
/// \return the least fibre, as in Plan
[[nodiscard]] std::optional<double> choose_courses(const CoverTask& task,
                                                   const std::vector<char>& joinable,
                                                   ProvenLibrary& library, PlanCourses& courses);

/// Anneals the courses, and adds others to fill the last thin places. After the last stage nothing
/// is made even.
void make_courses_even(const CoverTask& task, const AnnealGround& ground, const FibreReach& reach,
                       ProvenLibrary& library, PlanCourses& courses);

/// Removes courses, and strikes them off the library. A link is replaced by another.
/// \param refused the numbers of the courses, in order, each once
void give_up_courses(const CoverTask& task,
                     const std::vector<std::pair<std::size_t, CourseFault>>& refused,
                     ProvenLibrary& library, PlanCourses& courses);

/// Proves a course, sees whether it can be turned, and winds its own program. Thread-safe.
[[nodiscard]] CourseFault prove_to_stay(const CoverTask& task, const PlanCourses& courses,
                                        PlacedCourse& course);

/// Adds courses in place of those given up.
void replace_lost_courses(const CoverTask& task, const AnnealGround& ground,
                          const FibreReach& reach, ProvenLibrary& library, PlanCourses& courses);

/// Replaces the courses whose own programs do not lay them as planned.
void keep_courses_that_wind(const CoverTask& task, const AnnealGround& ground,
                            const FibreReach& reach, ProvenLibrary& library, PlanCourses& courses);

}  // namespace meshwind
