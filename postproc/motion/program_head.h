/// Content of a program besides its blocks: approach to the start, stop for the tie-on, path mode
/// at corners.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace meshwind {

/// Path mode of the controller at the ends of blocks, as set by words of the program.
struct PathMode {
    std::string words{};  ///< e.g. "G64 P2 Q0.01"; empty: none, the controller's default holds
    /// Largest cut of a corner, mm of the linear axes; infinite where the words set no bound, for
    /// then the controller keeps the feed, or slows down as an exact path needs.
    double corner_mm = std::numeric_limits<double>::infinity();
};

/// A mode from a block on.
struct PathModeFrom {
    PathMode mode{};
    std::size_t block = 0;  ///< the first one that runs in it
    std::int32_t line = 0;  ///< where it is set
};

/// A rapid move before the first feed move.
struct RapidMove {
    std::vector<std::int64_t> nano;  ///< per axis, at its end: absolute, 1e-9 mm or 1e-9 deg
    std::vector<bool> known;         ///< per axis: an absolute word has set its position
    std::vector<bool> named;         ///< per axis: it stands in this line
    std::int32_t line = 0;
};

/// Start of the head's comment with the digest of the code.
inline constexpr std::string_view kCodeDigest = "code digest: ";
/// Start of the comment with the digest of the job.
inline constexpr std::string_view kJobDigest = "job digest: ";

struct ProgramHead {
    bool by_meshwind = false;   ///< a comment says so
    std::string job_digest{};   ///< as the head has it; empty: it has none
    std::string code_digest{};  ///< the same
    bool has_approach = false;  ///< the language has words for the rest; pulses have none
    std::vector<RapidMove> approach{};
    /// Line of the stop M0 behind the last rapid move and before the first feed move; 0: there is
    /// none.
    std::int32_t stop_line = 0;
    std::vector<PathModeFrom> path_modes{};  ///< changes, in order; none: no such words
    /// One line each: an ambiguity in a program by others, and how it was read.
    std::vector<std::string> remarks{};
};

}  // namespace meshwind
