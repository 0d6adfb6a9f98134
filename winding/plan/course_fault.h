/// Reasons why a candidate is not admissible or a course is not laid.
#pragma once

#include <cstddef>
#include <cstdint>

namespace meshwind {

/// Why a candidate is not admissible, in the order of the checks.
enum class CandidateFault : std::uint8_t {
    None,
    NoRim,
    NotTurnable,  ///< by friction
    TouchesPins,  ///< on its way between two of them
    MissesPins,   ///< no course beside it ends where pins take hold of it
    Bridging,
    Slips,
    NotWindable
};
inline constexpr std::size_t kCandidateFaults = 8;

/// Words for a report: "reaches no rim", ...
[[nodiscard]] const char* name_of(CandidateFault refusal);

/// Why a course that the library admits is not laid after all, or not in one direction.
enum class CourseFault : std::uint8_t {
    None,
    Path,  ///< traced accurately, it bridges or ends where it cannot be turned
    Slip,
    FreeLength,
    AxisTravel,
    FibreHit,
    HeadHit,
    Laydown,     ///< its program, wound again, does not lay it as planned
    InItsPlace,  ///< the machine refuses it, or a turn next to it, between its neighbours
    Apart,       ///< no single fibre joins it to the others
    NotPlanned,  ///< too little of the wall is in reach
};
inline constexpr std::size_t kRejections = 11;

/// Words for a report: "the free fibre hits something", ...
[[nodiscard]] const char* name_of(CourseFault rejection);

}  // namespace meshwind
