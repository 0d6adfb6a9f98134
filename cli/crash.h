/// Errors of the program itself: one line, exit code 3, nothing half-written.
#pragma once

namespace meshwind {

/// From here on a failed assertion, an exception that nobody takes, std::abort and the signals of
/// broken memory and arithmetic (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS) end the process with exit
/// code 3 after one line on stderr that says what happened; the registered temporaries are removed
/// (cli/interrupt.h). Stacks that overflow, of any thread, too. Built with sanitizers the signals
/// are left to them.
void end_on_crashes();

}  // namespace meshwind
