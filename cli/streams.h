/// What goes to the standard streams.
#pragma once

#include <sstream>
#include <string>
#include <string_view>

namespace meshwind {

/// Opens those of stdin, stdout and stderr that the process was started without on /dev/null, so
/// that no file of the run gets one of their numbers and with it what was meant for them.
void open_standard_streams();

/// While one lives std::cout is kept in memory, so that the reason is known where it cannot be
/// written.
class HeldOutput {
public:
    HeldOutput();
    ~HeldOutput();
    HeldOutput(const HeldOutput&) = delete;
    HeldOutput& operator=(const HeldOutput&) = delete;

    /// Writes it to stdout, control characters in it but tabs and ends of lines as one_line() shows
    /// them. \return why not all of it has arrived; empty when it has
    [[nodiscard]] std::string write_out();

private:
    std::ostringstream held_;
    std::streambuf* before_;
};

/// The text in one line: control characters are shown as "\n" or "\x1b".
[[nodiscard]] std::string one_line(std::string_view text);

}  // namespace meshwind
