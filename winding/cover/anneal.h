/// Simulated annealing of courses: each is moved, turned and steered until all lie side by side.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "winding/cover/anneal_ground.h"
#include "winding/cover/balance_courses.h"
#include "winding/cover/placed_course.h"
#include "winding/cover/select_courses.h"

namespace meshwind {

struct AnnealOptions {
    SelectOptions select{};      ///< its targets are those of the ground's samples
    double beyond_layers = 1.0;  ///< layers that an even cover has beyond its target
    int fibres = 1;              ///< number that may lay the courses
    double fibre_share = 1.2;    ///< cost of each further one, as a share of what a course covers
    std::uint64_t seed = 1;
    std::int64_t proposals = 100'000;
    /// Chance of a change for the worse: 1/e where it costs this share of what a course covers. It
    /// falls from `hot` to `cold`, by the same factor in equal numbers of proposals.
    double hot = 0.1;
    double cold = 0.002;
    /// Cost of a layer short of the target, against 1 for a layer too many or too few; it rises as
    /// the chance falls: first all is made even, then the last holes are closed.
    double bare_hot = 45.0;
    double bare_cold = 180.0;
    /// Cost of fibre in turns, against 1 for a layer too many.
    double turn_share = 1.5;
    /// True where courses may lead; empty: anywhere.
    std::function<bool(const NodePair&)> way{};
    /// Checks a course that is about to be taken, and may make it exact; false where it cannot
    /// be wound. Must be pure and thread-safe. Empty: a sketch is enough.
    std::function<bool(PlacedCourse& course)> verify{};
    std::function<void(double share)> progress{};
};

/// Effort of an annealing; for reports.
struct AnnealEffort {
    std::int64_t proposals = 0;
    std::int64_t accepted = 0;
};

/// Simulated annealing over the courses themselves, not over a fixed library: courses are moved
/// sideways, turned, steered otherwise, replaced, set one band beside another, added and dropped.
/// The objective is the squared distance of the layers from `beyond_layers` more than the target,
/// summed over the samples. It adds `bare` for each layer short of the target, the fibre of the
/// turns, and a cost for what keeps the courses from being joined to at most `fibres` fibres.
/// Members of the library fill bare places, too. Proposals are drawn and judged in parallel, in
/// groups; the same for any number of threads.
/// \param courses changed in place; footprints are those of `rules` again at the end
AnnealEffort anneal(const CourseRules& rules, const AnnealGround& ground,
                    std::span<const LibraryCourse> library, std::span<const char> allowed,
                    std::vector<PlacedCourse>& courses, const AnnealOptions& options);

}  // namespace meshwind
