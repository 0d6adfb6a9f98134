/// Handles crashes of the program: one line, exit code 3, nothing half-written.
#pragma once

namespace meshwind {

/// From here on a failed assertion, an uncaught exception, std::abort and the signals of broken
/// memory and arithmetic (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS) end the process with exit code 3
/// after one line on stderr that names the cause; the registered temporaries are removed
/// (cli/interrupt.h). So does a stack overflow of any thread. In a build with sanitizers the
/// signals are left to them.
void end_on_crashes();

}  // namespace meshwind
