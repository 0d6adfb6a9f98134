/// Defines the options of the commands for CLI11.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/case_commands.h"
#include "cli/commands.h"
#include "cli/make_command.h"
#include "cli/program_commands.h"
#include "cli/shell_commands.h"

namespace meshwind {

/// Accepts digits only: the option library would take -1 for the largest number.
[[nodiscard]] CLI::Validator whole_number(std::uint64_t most);

/// Replaces CLI::IsMember, whose message proposes no word.
[[nodiscard]] CLI::Validator one_of(const std::vector<std::string_view>& words);

void add_wind_options(CLI::App& app, WindArguments& options, bool required);
void add_post(CLI::App& app, PostArguments& options);
void add_verify(CLI::App& app, VerifyArguments& options);
void add_resume(CLI::App& app, ResumeArguments& options);
void add_dry_run(CLI::App& app, DryRunArguments& options);
void add_repeat(CLI::App& app, RepeatArguments& options);
void add_show(CLI::App& app, ShowArguments& options);
void add_inspect(CLI::App& app, InspectArguments& options);
void add_make(CLI::App& app, MakeRequest& request);
void add_trace(CLI::App& app, TraceArguments& text);
void add_validate(CLI::App& app, ValidateArguments& options);
void add_mesh_size(CLI::App& app, StudyArguments& request);
void add_case(CLI::App& app, CaseArguments& arguments);
void add_merge(CLI::App& app, CaseArguments& arguments);
void add_export_fe(CLI::App& app, ShellArguments& arguments);
void add_strength(CLI::App& app, ShellArguments& arguments);
void add_carry(CLI::App& app, CarryArguments& text);
void add_design_vessel(CLI::App& app, DesignArguments& arguments);

}  // namespace meshwind
