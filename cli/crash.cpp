#include "cli/crash.h"

#include <array>
#include <cassert>
#include <charconv>
#include <csignal>
#include <exception>
#include <string_view>

#include <sys/mman.h>
#include <unistd.h>

#include "cli/exit_codes.h"
#include "cli/interrupt.h"
#include "core/files/temporaries.h"
#include "core/parallel.h"

namespace meshwind {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

// A line put together without memory of its own: whatever is broken, it can still be said.
class Line {
public:
    Line& operator<<(std::string_view words) noexcept {
        for (const char c : words) {
            if (size_ + 1 < text_.size()) {
                text_[size_++] = c < ' ' ? ' ' : c;
            }
        }
        return *this;
    }

    Line& operator<<(unsigned number) noexcept {
        std::array<char, 12> digits{};
        const auto end = std::to_chars(digits.begin(), digits.end(), number).ptr;
        return *this << std::string_view(digits.data(),
                                         static_cast<std::size_t>(end - digits.data()));
    }

    void write() noexcept {
        text_[size_++] = '\n';
        (void)!::write(STDERR_FILENO, text_.data(), size_);
    }

private:
    std::array<char, 1000> text_{};
    std::size_t size_ = 0;
};

[[noreturn]] void end(Line& line) noexcept {
    line << (remove_temporaries() ? "; nothing unfinished is left; "
                                  : "; files may be missing in the output folder, run again; ")
         << "please report it with the command and its input";
    line.write();
    ::_exit(kInternalError);
}

std::string_view name_of_signal(int signal) noexcept {
    switch (signal) {
        case SIGSEGV:
            return "memory that is not there was used (SIGSEGV)";
        case SIGBUS:
            return "memory that is not there was used (SIGBUS)";
        case SIGFPE:
            return "an integer division failed (SIGFPE)";
        case SIGILL:
            return "an instruction is not known (SIGILL)";
        case SIGSYS:
            return "a system call was refused (SIGSYS)";
        default:
            return "the program gave up (SIGABRT)";
    }
}

void on_crash(int signal) {
    Line line;
    line << "meshwind: internal error: " << name_of_signal(signal);
    end(line);
}

[[noreturn]] void on_terminate() noexcept {
    Line line;
    line << "meshwind: internal error: ";
    if (const std::exception_ptr thrown = std::current_exception()) {
        try {
            std::rethrow_exception(thrown);
        } catch (const std::exception& error) {
            line << error.what();
        } catch (...) {
            line << "something unknown was thrown";
        }
    } else {
        line << "the program gave up";
    }
    end(line);
}

// A handler cannot run on a stack that has overflowed. Stays until the process ends.
void give_thread_a_handler_stack() noexcept {
    constexpr std::size_t kBytes = 1 << 16;
    void* const memory =
        ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory != MAP_FAILED) {
        const stack_t stack{.ss_sp = memory, .ss_flags = 0, .ss_size = kBytes};
        ::sigaltstack(&stack, nullptr);
    }
}

// "core/units.h" of whatever folder the sources were in.
std::string_view last_two_names(std::string_view path) noexcept {
    std::size_t slash = path.rfind('/');
    slash = slash == std::string_view::npos || slash == 0 ? slash : path.rfind('/', slash - 1);
    return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

}  // namespace

void end_on_crashes() {
    std::set_terminate(on_terminate);
    struct sigaction action {};
    action.sa_handler = on_crash;
    action.sa_flags = SA_ONSTACK;
    ::sigfillset(&action.sa_mask);
    ::sigaction(SIGABRT, &action, nullptr);
    if (kSanitized) {
        return;
    }
    give_thread_a_handler_stack();
    on_worker_start(give_thread_a_handler_stack);
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS}) {
        ::sigaction(signal, &action, nullptr);
    }
}

}  // namespace meshwind

/// What the macro assert() calls, in place of the C library's, which would add lines of its own.
extern "C" void __assert_fail(const char* expression, const char* file, unsigned int line_number,
                              const char* /*function*/) noexcept {
    meshwind::Line line;
    line << "meshwind: internal error: " << meshwind::last_two_names(file) << ":" << line_number
         << ": '" << expression << "' does not hold";
    meshwind::end(line);
}
