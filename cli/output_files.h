/// Files of results: whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "cli/interrupt.h"

namespace meshwind {

/// Writes `bytes` to `file` in one step: whoever reads it sees the old text or the new one, never a
/// part. Links are followed; a device or pipe (/dev/stdout) is written directly. \throws IoError
/// output.unwritable
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// The output folder of one run. Files are collected under temporary names and appear together with
/// `publish`; without it nothing of the run remains, and what an earlier run left there is
/// untouched.
class OutputFolder {
public:
    /// Creates the folder, with its parents, where it is missing.
    /// \throws IoError output.unwritable, also when no file can be made in the folder
    explicit OutputFolder(std::filesystem::path folder);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    /// Writes a file to disk under a temporary name. \param name without folder, each name once
    /// \throws IoError output.unwritable
    void add(const std::string& name, std::string_view bytes);

    /// Has `publish` remove the file that an earlier run left under this name: a program that
    /// failed its checks must not leave an old one beside the new report.
    void withdraw(const std::string& name);

    /// Gives all files their names. \throws IoError output.unwritable, before the first file is
    /// renamed where the reason can be seen in advance (a folder of that name is in the way)
    void publish();

    [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

private:
    [[nodiscard]] std::filesystem::path temporary(const std::string& name) const;

    std::filesystem::path folder_;
    std::vector<std::filesystem::path> created_;  ///< folders made by this run, outermost first
    std::vector<std::string> added_;
    std::vector<std::string> withdrawn_;
    std::vector<Temporary> temporaries_;  ///< all of the run, for an end at once
};

}  // namespace meshwind
