/// Lock on an output folder: one run at a time.
#pragma once

#include <filesystem>

namespace meshwind {

/// Holds a folder for this run until the end of the object or of the process, whatever ends it. The
/// lock leaves nothing to be seen in the folder. File systems that cannot lock a folder (some
/// network drives) are left unlocked.
class FolderLock {
public:
    /// \throws IoError output.locked while another run has the folder; output.unwritable
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// Whether the locked folder is still the one of this name; another run may have removed it
    /// before it was locked.
    [[nodiscard]] bool holds(const std::filesystem::path& folder) const;

private:
    int descriptor_;
};

}  // namespace meshwind
