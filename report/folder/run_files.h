/// Files of a run in an output folder, and their roles.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace meshwind {

/// Role of a file of an output folder.
enum class FileRole {
    Report,   ///< judges the others
    Program,  ///< a machine may run it; of any controller language
    Table,    ///< all else
};

[[nodiscard]] FileRole role_of(const std::filesystem::path& name);

/// Whether the main job writes files of this name, with a machine of any controller.
[[nodiscard]] bool is_run_file(const std::filesystem::path& name);

/// Files in an output folder that an earlier run has left there, be it of the main job, `post`,
/// `carry` or `verify`: those with names that only runs give, and the programs that the report
/// there names. Sorted; without folder. \throws IoError output.unwritable where the folder cannot
/// be listed
[[nodiscard]] std::vector<std::string> files_of_earlier_run(const std::filesystem::path& folder);

/// Makes sure that a run does not replace its own inputs. \param inputs files that exist; empty
/// ones do not count
/// \throws InputError output.holds_input for one that files_of_earlier_run() of `folder` has
void spare_inputs(const std::filesystem::path& folder,
                  const std::vector<std::filesystem::path>& inputs);

}  // namespace meshwind
