#include "mesh/brep/read_cad.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/text/text_number.h"
#include "mesh/io/import.h"

extern char** environ;

namespace meshwind {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> kEndings = {".step", ".stp", ".iges", ".igs", ".brep"};

constexpr int kWait_ms = 100;  // between two cancellation points

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

// A running program whose standard output is read; it ends with this at the latest.
class Child {
public:
    Child(const fs::path& program, std::array<std::string, 3> arguments, const std::string& name) {
        std::array<int, 2> ends{};
        if (pipe2(ends.data(), O_CLOEXEC) != 0) {
            fail(name, errno);
        }
        output_ = ends[0];
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        std::string own = program.string();
        std::array<char*, 5> argv = {own.data(), arguments[0].data(), arguments[1].data(),
                                     arguments[2].data(), nullptr};
        const int error =
            posix_spawn(&process_, own.c_str(), &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        close(ends[1]);
        if (error != 0) {
            close(output_);
            process_ = -1;
            fail(name, error);
        }
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        if (process_ > 0) {
            kill(process_, SIGKILL);
            waitpid(process_, nullptr, 0);
        }
        close(output_);
    }

    [[nodiscard]] std::string output() const {
        std::string bytes;
        std::array<char, 1 << 16> piece{};
        while (true) {
            check_interrupt();
            pollfd wait{output_, POLLIN, 0};
            if (poll(&wait, 1, kWait_ms) <= 0) {
                continue;
            }
            const ssize_t count = read(output_, piece.data(), piece.size());
            if (count > 0) {
                bytes.append(piece.data(), static_cast<std::size_t>(count));
            } else if (count == 0 || errno != EINTR) {
                return bytes;
            }
        }
    }

    /// Waits for its end. \return as waitpid has it
    [[nodiscard]] int status() {
        int result = 0;
        while (waitpid(process_, &result, 0) < 0 && errno == EINTR) {
        }
        process_ = -1;
        return result;
    }

private:
    [[noreturn]] static void fail(const std::string& name, int error) {
        throw InputError("mesh.cad_failed", name,
                         std::string("the CAD reader cannot be started (") + std::strerror(error) +
                             "); install meshwind again");
    }

    pid_t process_ = -1;
    int output_ = -1;
};

// What the reader says is wrong: code, place and words, a line each.
[[noreturn]] void pass_on(const std::string& output, int status, const std::string& name) {
    if (WIFEXITED(status) && WEXITSTATUS(status) == 2) {
        const std::size_t code = output.find('\n');
        const std::size_t place = code == std::string::npos ? code : output.find('\n', code + 1);
        const std::size_t words = place == std::string::npos ? place : output.find('\n', place + 1);
        if (words != std::string::npos) {
            throw InputError(output.substr(0, code), output.substr(code + 1, place - code - 1),
                             output.substr(place + 1, words - place - 1));
        }
    }
    const std::string how =
        WIFSIGNALED(status) ? "is killed by it (signal " + std::to_string(WTERMSIG(status)) + ")"
                            : "ends with code " + std::to_string(WEXITSTATUS(status));
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
    Child child(program, {name, solid, fixed(edge_mm, kEdgeDecimals)}, name);
    const std::string output = child.output();
    const int status = child.status();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        pass_on(output, status, name);
    }
    return cad_mesh_of(output, name);
}

}  // namespace meshwind
