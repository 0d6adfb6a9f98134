/// The commands that take a program: verify, resume, dry-run, repeat, show.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "cli/commands.h"

namespace meshwind {

/// Inputs for winding a program again. Empty ones are taken from the program's head.
struct ProgramArguments {
    std::string program, mandrel, machine, tie_on;
    std::string frame = "mandrel";  // of tie_on
    JobArguments job;
};

struct VerifyArguments : ProgramArguments {
    std::string plan, out;
};

struct ResumeArguments : ProgramArguments {
    std::string out;
    std::optional<std::size_t> block;
    std::optional<std::int32_t> line;
};

struct DryRunArguments : ProgramArguments {
    std::string out;
    double clearance_mm = 100.0;
};

/// Repeats the main job that made a program.
struct RepeatArguments {
    std::string program, mandrel, machine;
    JobArguments job;  ///< settings alone
    std::string out = "meshwind-repeat";
    PreviewOptions png;
};

/// Shows a run's folder, a program, or a mandrel.
struct ShowArguments {
    std::string what, out;
    ProgramArguments program;
};

/// As the commands of commands.h.
[[nodiscard]] int run_verify_command(const VerifyArguments& arguments, const Common& common);
[[nodiscard]] int run_resume(const ResumeArguments& arguments, const Common& common);
[[nodiscard]] int run_dry_run(const DryRunArguments& arguments, const Common& common);
[[nodiscard]] int run_repeat(const RepeatArguments& arguments, const Common& common);
[[nodiscard]] int run_show(ShowArguments arguments, const Common& common);

}  // namespace meshwind
