/// Ctrl-C: a run ends soon and leaves nothing half-written.
#pragma once

#include <filesystem>

namespace meshwind {

/// From here on SIGINT and SIGTERM ask for the end of the run, which then unwinds from its next
/// cancellation point (core/interrupt.h) and removes what it has begun. A second signal removes
/// the registered temporaries and ends the process at once, exit code 128 + its number. A signal
/// that the process was started to ignore stays ignored.
void end_on_signals();

/// A file or folder that is removed when the process is ended at once; of folders those that are
/// empty. Registered from before it is made until the object's end, which removes nothing.
class Temporary {
public:
    explicit Temporary(const std::filesystem::path& path);
    ~Temporary();
    Temporary(Temporary&& other) noexcept;
    Temporary& operator=(Temporary&& other) noexcept;

private:
    int slot_ = -1;
};

/// While one lives a second signal waits: what has to be done whole.
class Unbroken {
public:
    Unbroken();
    ~Unbroken();
    Unbroken(const Unbroken&) = delete;
    Unbroken& operator=(const Unbroken&) = delete;
};

}  // namespace meshwind
