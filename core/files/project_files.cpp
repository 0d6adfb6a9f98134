#include "core/files/project_files.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "core/text/strict_json.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMachines = "machines";
constexpr const char* kProfiles = "data/profiles";

constexpr std::array kFolders = {"data/meshes", "data", "data/materials", kProfiles, kMachines};

// Names of the JSON files of a folder, in their order.
std::vector<std::string> shipped(const char* folder) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(project_home() / folder, ignored)) {
        if (entry.path().extension() == ".json") {
            names.push_back(entry.path().filename().string());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

void require_file(const fs::path& file, const char* folder, const std::string& what) {
    std::error_code ignored;
    if (fs::exists(file, ignored)) {
        return;
    }
    const std::vector<std::string> names = shipped(folder);
    const std::vector<std::string_view> known(names.begin(), names.end());
    std::string wanted = file.filename().string();
    if (file.extension() != ".json") {
        wanted += ".json";
    }
    const auto near = nearest_word(wanted, known);
    std::string words = "there is no such " + what + " file";
    words += near ? "; did you mean \"" + std::string(*near) + "\"?" : ";";
    for (std::size_t i = 0; i < known.size(); ++i) {
        words += i == 0 ? " These come with meshwind: " : ", ";
        words += known[i];
    }
    throw IoError("io.cannot_read", file.string(), words);
}

}  // namespace

fs::path project_home() {
    const char* const home = std::getenv("MESHWIND_HOME");
    if (home != nullptr && *home != '\0') {
        return home;
    }
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    const fs::path beside =
        (program.parent_path() / MESHWIND_SHARE_FROM_PROGRAM).lexically_normal();
    for (const fs::path& share : {beside, fs::path(MESHWIND_INSTALLED_SHARE)}) {
        if (fs::is_directory(share / "machines", ignored)) {
            return share;
        }
    }
    return MESHWIND_SOURCE_DIR;
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
    for (const char* const folder : {kMachines, kProfiles}) {
        const fs::path named = project_home() / folder / (name + ".json");
        if (fs::is_regular_file(named, ignored)) {
            return named;
        }
    }
    return name;
}

std::vector<std::string> shipped_machines() {
    return shipped(kMachines);
}

std::vector<std::string> shipped_profiles() {
    return shipped(kProfiles);
}

void require_machine_file(const fs::path& file) {
    require_file(file, kMachines, "machine");
}

void require_profile_file(const fs::path& file) {
    require_file(file, kProfiles, "material or process");
}

}  // namespace meshwind
