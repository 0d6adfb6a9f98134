/// One run at a time in an output folder.
#pragma once

#include <filesystem>

namespace meshwind {

/// Holds a folder for this run until the end of the object or of the process, whatever ends it.
/// Nothing of it is seen in the folder. File systems that cannot lock a folder (some network
/// drives) are left unlocked.
class FolderLock {
public:
    /// \throws IoError output.locked while another run has the folder; output.unwritable
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// Whether the folder that is held is the one of this name; another run may have removed it
    /// before it was locked.
    [[nodiscard]] bool holds(const std::filesystem::path& folder) const;

private:
    int descriptor_;
};

}  // namespace meshwind
