#include "cli/project_files.h"

#include <array>
#include <cstdlib>
#include <system_error>

namespace meshwind {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 3> kFolders = {"data/meshes", "data", "machines"};

}  // namespace

fs::path project_home() {
    const char* const home = std::getenv("MESHWIND_HOME");
    if (home != nullptr && *home != '\0') {
        return home;
    }
    const fs::path installed = MESHWIND_INSTALLED_SHARE;
    std::error_code ignored;
    return fs::is_directory(installed, ignored) ? installed : fs::path(MESHWIND_SOURCE_DIR);
}

fs::path find_input(const std::string& name) {
    std::error_code ignored;
    if (fs::exists(name, ignored) || name.empty() || fs::path(name).has_parent_path()) {
        return name;
    }
    for (const char* const folder : kFolders) {
        const fs::path candidate = project_home() / folder / name;
        if (fs::is_regular_file(candidate, ignored)) {
            return candidate;
        }
    }
    return name;
}

}  // namespace meshwind
