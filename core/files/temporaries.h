/// Temporary files, removed when the process is ended at once.
#pragma once

#include <atomic>
#include <filesystem>

namespace meshwind {

/// Removes the registered temporaries, unless an Unbroken lives at this moment. Safe in a signal
/// handler. \return whether they were removed
bool remove_temporaries() noexcept;

/// A file or folder that is removed when the process is ended at once; a folder only if it is
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

/// A file that is removed at the end of the object, unless renamed by then; also when the process
/// is ended at once.
class RemovedInTheEnd {
public:
    explicit RemovedInTheEnd(std::filesystem::path file);
    ~RemovedInTheEnd();
    RemovedInTheEnd(const RemovedInTheEnd&) = delete;
    RemovedInTheEnd& operator=(const RemovedInTheEnd&) = delete;

private:
    std::filesystem::path file_;
    Temporary registered_;
};

/// Guards a step that has to be done whole: while one lives, an end at once waits.
class Unbroken {
public:
    Unbroken();
    ~Unbroken();
    Unbroken(const Unbroken&) = delete;
    Unbroken& operator=(const Unbroken&) = delete;
};

}  // namespace meshwind
