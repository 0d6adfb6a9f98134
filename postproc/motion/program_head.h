/// What a program says before and beside its blocks: how the machine gets to the start, where it
/// stops for the fibre, how the controller goes past corners.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace meshwind {

/// How the controller goes past the ends of blocks, as words of the program ask.
struct PathMode {
    std::string words{};  ///< e.g. "G64 P2 Q0.01"; empty: none were said, the controller's own
    /// How far corners may be cut, mm of the linear axes; infinite where the words set no bound,
    /// for then the controller keeps the feed, or slows down as an exact path asks.
    double corner_mm = std::numeric_limits<double>::infinity();
};

/// A mode from a block on.
struct PathModeFrom {
    PathMode mode{};
    std::size_t block = 0;  ///< the first one that runs in it
    std::int32_t line = 0;  ///< where it is said
};

/// A rapid move before the first feed move.
struct RapidMove {
    std::vector<std::int64_t> nano;  ///< per axis, at its end: absolute, 1e-9 mm or 1e-9 deg
    std::vector<bool> known;         ///< per axis: an absolute word has said where it is
    std::vector<bool> named;         ///< per axis: it stands in this line
    std::int32_t line = 0;
};

/// What the head's comment with the digest of the code begins with.
inline constexpr std::string_view kCodeDigest = "code digest: ";
/// And that of the job.
inline constexpr std::string_view kJobDigest = "job digest: ";

struct ProgramHead {
    bool by_meshwind = false;   ///< a comment says so
    std::string job_digest{};   ///< as the head has it; empty: it has none
    std::string code_digest{};  ///< the same
    bool has_approach = false;  ///< the language has words for the rest; pulses have none
    std::vector<RapidMove> approach{};
    /// Of the stop M0 behind the last rapid move and before the first feed move; 0: there is none.
    std::int32_t stop_line = 0;
    std::vector<PathModeFrom> path_modes{};  ///< changes, in order; none: no words were said
    /// One line each: what a program by others leaves open, and how it was taken.
    std::vector<std::string> remarks{};
};

}  // namespace meshwind
