#include "mesh/brep/read_cad.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <vector>

#include <unistd.h>

#include "core/child_program.h"
#include "core/error.h"
#include "core/text/text_number.h"
#include "mesh/io/import.h"

namespace meshwind {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> kEndings = {".step", ".stp", ".iges", ".igs", ".brep"};

// Empty where there is none.
fs::path cad_program() {
    std::error_code ignored;
    const char* const named = std::getenv("MESHWIND_CAD");
    const fs::path here = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    const std::vector<fs::path> candidates =
        named != nullptr && *named != '\0'
            ? std::vector<fs::path>{named}
            : std::vector<fs::path>{here / MESHWIND_CAD_FROM_PROGRAM, MESHWIND_INSTALLED_CAD,
                                    MESHWIND_BUILT_CAD};
    for (const fs::path& candidate : candidates) {
        if (fs::is_regular_file(candidate, ignored)) {
            return candidate.lexically_normal();
        }
    }
    return {};
}

ProgramEnd run_reader(const fs::path& program, const std::vector<std::string>& arguments,
                      const std::string& name) {
    try {
        return run_program(program, arguments);
    } catch (const std::system_error& error) {
        throw InputError("mesh.cad_failed", name,
                         std::string("the CAD reader cannot be started (") + error.what() +
                             "); install meshwind again");
    }
}

// What the reader says is wrong: code, place and words, a line each.
[[noreturn]] void pass_on(const ProgramEnd& end, const std::string& name) {
    const std::string& output = end.output;
    if (end.signal == 0 && end.exit_code == 2) {
        const std::size_t code = output.find('\n');
        const std::size_t place = code == std::string::npos ? code : output.find('\n', code + 1);
        const std::size_t words = place == std::string::npos ? place : output.find('\n', place + 1);
        if (words != std::string::npos) {
            throw InputError(output.substr(0, code), output.substr(code + 1, place - code - 1),
                             output.substr(place + 1, words - place - 1));
        }
    }
    const std::string how = end.signal != 0
                                ? "is killed by it (signal " + std::to_string(end.signal) + ")"
                                : "ends with code " + std::to_string(end.exit_code);
    throw InputError("mesh.cad_failed", name,
                     "the CAD reader " + how + "; export the part again, or as .stl");
}

void check_file(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status)) {
        throw IoError("mesh.missing_file", file.string(), "no such file, check the name");
    }
    if (!fs::is_regular_file(status) || access(file.c_str(), R_OK) != 0) {
        throw IoError("mesh.unreadable", file.string(),
                      "cannot be read, check that it is a file and its permissions");
    }
}

}  // namespace

bool is_cad(const fs::path& file) {
    return std::find(kEndings.begin(), kEndings.end(), lower_ending(file)) != kEndings.end();
}

CadMesh read_cad(const fs::path& file, const std::string& solid, double edge_mm) {
    const std::string name = file.string();
    check_file(file);
    const fs::path program = cad_program();
    if (program.empty()) {
        throw InputError("mesh.no_cad", name,
                         "this meshwind was built without Open CASCADE, which reads CAD files; "
                         "install libocct-data-exchange-dev and build it again, or export the "
                         "part as .stl");
    }
    constexpr int kEdgeDecimals = 6;
    const ProgramEnd end = run_reader(program, {name, solid, fixed(edge_mm, kEdgeDecimals)}, name);
    if (end.signal != 0 || end.exit_code != 0) {
        pass_on(end, name);
    }
    return cad_mesh_of(end.output, name);
}

}  // namespace meshwind
