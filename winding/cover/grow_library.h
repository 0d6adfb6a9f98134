/// Grows the library of courses: candidates over the whole wall, then where they are still needed.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "winding/cover/balance_courses.h"
#include "winding/cover/cover.h"
#include "winding/laminate/samples.h"

namespace meshwind {

/// The members, with the outcome of all candidates.
struct Library {
    std::vector<LibraryCourse> members;
    std::vector<char> reached;  ///< per sample: 1 where a member passes
    std::vector<CandidateFault>
        closest_miss;  ///< per sample: the last check that a candidate there failed
    std::int64_t candidates = 0;
    std::array<std::int64_t, kCandidateFaults> refusals{};
    Judging judging = Judging::Sketches;  ///< how the members were judged
};

/// The courses that lead from one node (see balance_courses.h) to another, each member at most
/// once.
struct Way {
    std::vector<std::int32_t> lying;     ///< indices of members, windable in this direction or not
    std::vector<std::int32_t> windable;  ///< those that can be wound in this direction
};
using Ways = std::map<NodePair, Way>;

[[nodiscard]] Ways ways_between_nodes(std::span<const LibraryCourse> members);

/// Tries candidates over the whole wall. Where the first show that sketches cannot be relied on, as
/// on sharp creases or coarse blends, all are judged by every rule from then on. Then come rounds
/// through samples that no member reaches, then near members of scarce ways between nodes. The same
/// for any number of threads.
[[nodiscard]] Library grow_library(const CourseRules& rules, const CoverageSamples& samples,
                                   const CoverOptions& options);

/// Share of the samples that are reached. \param reached per sample, 1 or 0
[[nodiscard]] double reached_share(std::span<const char> reached);

/// Share of the samples that courses reach under other rules: those reached already, and those that
/// further candidates through the others reach. \param reached per sample \param judging as it was
[[nodiscard]] double reach_with(const CourseRules& rules, const CoverageSamples& samples,
                                std::span<const char> reached, Judging judging, std::uint64_t seed);

}  // namespace meshwind
