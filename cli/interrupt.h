/// Ends before the time: asked for by a signal, nothing half-written is left.
#pragma once

#include <atomic>
#include <filesystem>

namespace meshwind {

/// From here on SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGXFSZ and SIGPIPE ask for the end of the run,
/// which then unwinds from its next cancellation point (core/interrupt.h) and removes what it has
/// begun. Where it has not ended after 0.8 s, in a call that has no such point, and on a second
/// signal, the process ends at once; it removes the registered temporaries. The exit code is 128 +
/// the number of the first signal. A signal that the process was started to ignore stays ignored.
void end_on_signals();

/// Says on stderr that the run was interrupted, and ends the process with the exit code of its
/// signal. \pre an end was asked for, and nothing is left to be removed
[[noreturn]] void end_interrupted();

/// Removes the registered temporaries, unless something is done whole at this moment. Safe in a
/// signal handler. \return whether they were removed
bool remove_temporaries() noexcept;

/// A file or folder that is removed when the process is ended at once; of folders those that are
/// empty. Registered from before it is made until the object's end, which removes nothing.
class Temporary {
public:
    explicit Temporary(const std::filesystem::path& path);
    ~Temporary();
    Temporary(Temporary&& other) noexcept;
    Temporary& operator=(Temporary&& other) noexcept;

private:
    std::atomic<bool>* registered_ = nullptr;  ///< of the name's entry; none once moved from
};

/// While one lives an end at once waits: what has to be done whole.
class Unbroken {
public:
    Unbroken();
    ~Unbroken();
    Unbroken(const Unbroken&) = delete;
    Unbroken& operator=(const Unbroken&) = delete;
};

}  // namespace meshwind
