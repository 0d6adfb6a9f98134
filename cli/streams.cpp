#include "cli/streams.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>

#include <fcntl.h>
#include <unistd.h>

namespace meshwind {
namespace {

// Names of files and machines may hold what a terminal would obey.
std::string shown(std::string_view text, std::string_view as_they_are) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string all;
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if ((code >= ' ' && code != 0x7f) || as_they_are.find(c) != std::string_view::npos) {
            all += c;
        } else if (c == '\n') {
            all += "\\n";
        } else {
            all += {'\\', 'x', kDigits[code / 16U], kDigits[code % 16U]};
        }
    }
    return all;
}

}  // namespace

void open_standard_streams() {
    for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(number, F_GETFD) < 0 && errno == EBADF) {
            // The lowest number that is free: this one.
            (void)!::open("/dev/null", number == STDIN_FILENO ? O_RDONLY : O_WRONLY);
        }
    }
}

HeldOutput::HeldOutput() : before_(std::cout.rdbuf(held_.rdbuf())) {}

HeldOutput::~HeldOutput() {
    std::cout.rdbuf(before_);
}

std::string HeldOutput::write_out() {
    const std::string text = shown(held_.str(), "\n\t");
    held_.str({});
    std::string_view rest = text;
    while (!rest.empty()) {
        const ssize_t count = ::write(STDOUT_FILENO, rest.data(), rest.size());
        if (count < 0 && errno != EINTR) {
            return std::strerror(errno);
        }
        rest.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
    return {};
}

std::string one_line(std::string_view text) {
    return shown(text, "");
}

}  // namespace meshwind
