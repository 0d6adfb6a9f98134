/// The commands that take a program: verified, resumed, wound anew, shown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "cli/commands.h"

namespace meshwind {

/// What a program is wound again with. What is empty is as the program's head says.
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

/// The main job that made a program, once more.
struct RepeatArguments {
    std::string program, mandrel, machine;
    JobArguments job;  ///< settings alone
    std::string out = "meshwind-repeat";
    PreviewOptions png;
};

/// What there is to see of a run's folder, a program, or a mandrel.
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
