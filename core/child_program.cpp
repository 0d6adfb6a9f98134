#include "core/child_program.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/interrupt.h"

extern char** environ;

namespace meshwind {
namespace {

constexpr int kWait_ms = 100;  // between two cancellation points

// A running program whose standard output is read; it ends with this at the latest.
class Child {
public:
    Child(std::vector<std::string> words, const std::string& folder) {
        std::array<int, 2> ends{};
        if (pipe2(ends.data(), O_CLOEXEC) != 0) {
            throw std::system_error(errno, std::generic_category());
        }
        output_ = ends[0];
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        if (!folder.empty()) {
            posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
        }
        std::vector<char*> argv;
        argv.reserve(words.size() + 1);
        for (std::string& word : words) {
            argv.push_back(word.data());
        }
        argv.push_back(nullptr);
        const int error =
            posix_spawnp(&process_, argv.front(), &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        close(ends[1]);
        if (error != 0) {
            close(output_);
            throw std::system_error(error, std::generic_category());
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

    // Waits for its end. \return as waitpid has it
    [[nodiscard]] int status() {
        int result = 0;
        while (waitpid(process_, &result, 0) < 0 && errno == EINTR) {
        }
        process_ = -1;
        return result;
    }

private:
    pid_t process_ = -1;
    int output_ = -1;
};

}  // namespace

ProgramEnd run_program(const std::filesystem::path& program,
                       const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder) {
    std::vector<std::string> words = {program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    Child child(std::move(words), folder.string());
    ProgramEnd end{.output = child.output()};
    const int status = child.status();
    if (WIFSIGNALED(status)) {
        end.signal = WTERMSIG(status);
    } else {
        end.exit_code = WEXITSTATUS(status);
    }
    return end;
}

}  // namespace meshwind
