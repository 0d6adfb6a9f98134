/// The output folder of a run: whole or not at all.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/disk_file.h"
#include "core/files/folder_lock.h"
#include "core/files/temporaries.h"

namespace meshwind {

/// The output folder of one run, which no other run can have at the same time. Files are collected
/// under temporary names and appear together with `publish`; without it nothing of the run remains,
/// and files of an earlier run are untouched.
class OutputFolder {
public:
    /// Creates the folder, with its parents, where it is missing; removes temporary files of killed
    /// runs.
    /// \throws IoError output.locked while another run has the folder; output.unwritable, also when
    /// no file can be made in the folder
    explicit OutputFolder(std::filesystem::path folder);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    /// Writes a file to disk under a temporary name. \param name without folder, each name once
    /// \throws IoError output.unwritable
    void add(const std::string& name, std::string_view bytes);

    /// The same piece by piece. \throws what the source throws
    void add(const std::string& name, const ByteSource& source);

    /// Makes `publish` remove an earlier run's file of this name.
    void withdraw(const std::string& name);

    /// Makes `publish` remove all files of an earlier run that the report of this one will not
    /// describe (files_of_earlier_run), so that no program lies beside a report that is not its
    /// own.
    void withdraw_earlier_run();

    /// Gives all files their names. At every moment the folder has only programs that the report in
    /// it describes: the old programs and their report go first, then tables come, the new report,
    /// and its programs last. All is on the disk on return.
    /// \throws IoError output.unwritable; the folder is then as it was before
    void publish();

    [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

private:
    void open();
    void create_folders();
    void remove_created();
    [[nodiscard]] std::filesystem::path staged(const std::string& name) const;

    std::filesystem::path folder_;
    std::optional<FolderLock> lock_;
    std::vector<std::filesystem::path> created_;  ///< folders made by this run, outermost first
    std::vector<std::string> added_;
    std::vector<std::string> withdrawn_;
    std::vector<Temporary> temporaries_;  ///< all of the run, for an end at once
};

}  // namespace meshwind
