/// Runs another program and waits for its end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace meshwind {

struct ProgramEnd {
    std::string output;  ///< text of its standard output
    int exit_code = 0;
    int signal = 0;  ///< the signal that killed it; 0: none
};

/// Runs a program: its standard input is empty, its standard error is ours; an interruption kills
/// it.
/// \param program a path, or a name that is looked up in PATH
/// \param folder its working folder; empty: ours
/// \throws std::system_error where it cannot be started
[[nodiscard]] ProgramEnd run_program(const std::filesystem::path& program,
                                     const std::vector<std::string>& arguments,
                                     const std::filesystem::path& folder = {});

}  // namespace meshwind
