/// Ends a run early on a signal, leaving nothing half-written.
#pragma once

namespace meshwind {

/// From here on SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGXFSZ and SIGPIPE ask for the end of the run,
/// which then unwinds from its next cancellation point (core/interrupt.h) and removes its
/// unfinished files. Where it has not ended after 0.8 s, in a call that has no such point, and on a
/// second signal, the process ends at once; it removes the registered temporaries. The exit code is
/// 128 + the number of the first signal. A signal that the process was started to ignore stays
/// ignored.
void end_on_signals();

/// Says on stderr that the run was interrupted, and ends the process with the exit code of its
/// signal. \pre an end was asked for, and nothing is left to be removed
[[noreturn]] void end_interrupted();

}  // namespace meshwind
