/// Exit codes of the program.
#pragma once

namespace meshwind {

inline constexpr int kDone = 0;
inline constexpr int kCheckFailed = 1;
inline constexpr int kBadInput = 2;
inline constexpr int kInternalError = 3;  ///< or the output could not be written
inline constexpr int kInterrupted = 128;  ///< and the signal's number, as shells have it

}  // namespace meshwind
