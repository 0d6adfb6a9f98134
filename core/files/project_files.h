/// Finds the meshes and machines that come with the program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meshwind {

/// The folder that holds data/ and machines/: $MESHWIND_HOME when set (the launcher sets it), else
/// share/meshwind of the folder that the program is installed in, wherever that was moved to, else
/// the one of the configured prefix, else the source folder that the program was built from.
[[nodiscard]] std::filesystem::path project_home();

/// The file a user means by `name`: that path when it exists; else, for a bare name such as
/// "tee.stl", the file of this name in data/meshes, data, data/materials, data/profiles or machines
/// of `project_home()`, or the machine or profile of this name there, "six_axis"; else `name`.
[[nodiscard]] std::filesystem::path find_input(const std::string& name);

/// Names of the machine files that come with the program, in their order.
[[nodiscard]] std::vector<std::string> shipped_machines();

/// Names of the profiles of materials and processes that come with the program.
[[nodiscard]] std::vector<std::string> shipped_profiles();

/// \throws IoError io.cannot_read where there is no such file, with the nearest of the machines
/// that come with the program, and all of them
void require_machine_file(const std::filesystem::path& file);

/// The same of materials and processes.
void require_profile_file(const std::filesystem::path& file);

}  // namespace meshwind
