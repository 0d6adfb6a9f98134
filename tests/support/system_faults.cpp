#include "tests/support/system_faults.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

namespace meshwind::faults {
namespace {

std::atomic<Fault> armed{Fault::None};
std::atomic<int> at{0};
std::atomic<int> count{0};

// Whether this call has to fail.
bool fails() {
    const int number = ++count;
    const Fault fault = armed.load();
    if (fault == Fault::None || number < at || (number > at && fault != Fault::FailOn)) {
        return false;
    }
    if (const char* const file = std::getenv("MESHWIND_FAULT_FILE"); file != nullptr) {
        ::close(::creat(file, 0666));  // tells that it came to this call
    }
    if (fault == Fault::Kill) {
        ::kill(::getpid(), SIGKILL);
    }
    if (fault == Fault::Abort) {
        std::abort();
    }
    errno = EACCES;
    return true;
}

template <typename Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

void arm(Fault fault, int n) {
    count = 0;
    at = n;
    armed = fault;
}

int calls() {
    return count;
}

}  // namespace meshwind::faults

// In place of the C library's, for the program and all of its libraries.
extern "C" {

int rename(const char* from, const char* to) noexcept {
    static auto* const kReal = meshwind::faults::real<int(const char*, const char*)>("rename");
    return meshwind::faults::fails() ? -1 : kReal(from, to);
}

int link(const char* from, const char* to) noexcept {
    static auto* const kReal = meshwind::faults::real<int(const char*, const char*)>("link");
    return meshwind::faults::fails() ? -1 : kReal(from, to);
}

int unlink(const char* path) noexcept {
    static auto* const kReal = meshwind::faults::real<int(const char*)>("unlink");
    return meshwind::faults::fails() ? -1 : kReal(path);
}

int fsync(int descriptor) {
    static auto* const kReal = meshwind::faults::real<int(int)>("fsync");
    return meshwind::faults::fails() ? -1 : kReal(descriptor);
}

}  // extern "C"

namespace {

// As a library that is loaded before the others: MESHWIND_FAULT=kill:3
[[gnu::constructor]] void arm_from_environment() {
    using meshwind::faults::Fault;
    const char* const text = std::getenv("MESHWIND_FAULT");
    if (text == nullptr) {
        return;
    }
    const char* number = text;
    while (*number != '\0' && *number != ':') {
        ++number;
    }
    const Fault fault = text[0] == 'k'   ? Fault::Kill
                        : text[0] == 'a' ? Fault::Abort
                        : text[0] == 'o' ? Fault::FailOnce
                                         : Fault::FailOn;
    meshwind::faults::arm(fault, *number == ':' ? std::atoi(number + 1) : 1);
}

}  // namespace
