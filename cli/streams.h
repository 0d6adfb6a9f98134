/// Safe use of the standard streams.
#pragma once

#include <sstream>
#include <string>
#include <string_view>

namespace meshwind {

/// Opens those of stdin, stdout and stderr that the process was started without on /dev/null, so
/// that no file of the run gets one of their numbers and with it their output.
void open_standard_streams();

/// Holds std::cout in memory during its lifetime, so that the reason is known where it cannot be
/// written.
class HeldOutput {
public:
    HeldOutput();
    ~HeldOutput();
    HeldOutput(const HeldOutput&) = delete;
    HeldOutput& operator=(const HeldOutput&) = delete;

    /// Writes it to stdout, with control characters, except tabs and ends of lines, as one_line()
    /// shows them. \return why not all of it has arrived; empty when it has
    [[nodiscard]] std::string write_out();

private:
    std::ostringstream held_;
    std::streambuf* before_;
};

/// The text in one line: control characters are shown as "\n" or "\x1b".
[[nodiscard]] std::string one_line(std::string_view text);

}  // namespace meshwind
