/// Calls of the system that fail, or at which the process is killed, one after the other: what a
/// full disk, a lost network drive or a power cut do.
#pragma once

namespace meshwind::faults {

/// What happens at the call.
enum class Fault {
    None,
    Kill,      ///< SIGKILL: nothing of the process runs any more
    FailOnce,  ///< EACCES from this call, the later ones work
    FailOn,    ///< EACCES from this call and all later ones
    Abort,     ///< std::abort
};

/// From here on the `n`-th call (from 1) of rename, link, unlink or fsync does that.
void arm(Fault fault, int n);

/// Calls since `arm`.
[[nodiscard]] int calls();

}  // namespace meshwind::faults
