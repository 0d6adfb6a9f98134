/// Files of a folder exchanged for others, all of them or none.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meshwind {

/// Takes the files `taken` away, where they are, and gives the staged files `put` (disk_file.h)
/// their names. Programs go first, then reports, then the rest; the rest comes first, then
/// reports, programs last. So at every moment, whatever ends the process, each program in the
/// folder is one that the report in it describes. All is on the disk on return. \throws IoError
/// output.unwritable; the folder is then as it was. Where the file system does not let it be, a
/// program that was put keeps its report, and one comes back only after its report.
void replace_files(const std::filesystem::path& folder, const std::vector<std::string>& taken,
                   const std::vector<std::string>& put);

}  // namespace meshwind
