/// Replaces files of a folder, all of them or none.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meshwind {

/// Removes the files `taken`, where present, and gives the staged files `put` (disk_file.h) their
/// names. Programs are removed first, then reports, then the rest; the rest is put first, then
/// reports, programs last. At every moment, whatever ends the process, the report in the folder
/// describes each program in it. All is on the disk on return. \throws IoError output.unwritable;
/// the folder is then as it was. Where the file system prevents that, a program that was put keeps
/// its report, and a removed one comes back only after its report.
void replace_files(const std::filesystem::path& folder, const std::vector<std::string>& taken,
                   const std::vector<std::string>& put);

}  // namespace meshwind
