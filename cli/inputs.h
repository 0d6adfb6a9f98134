/// Helpers of several commands for arguments and results.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "cli/commands.h"
#include "cli/progress.h"
#include "core/run_context.h"
#include "postproc/verify/verify.h"

namespace meshwind {

/// Unit of --units; 0 where it is not given, or auto.
[[nodiscard]] double unit_mm(const std::string& name);

/// Three numbers, "X,Y,Z". \param option that has them, for the message
/// \throws InputError cli.vector
[[nodiscard]] Eigen::Vector3d vector_of(const std::string& option, const std::string& text);

/// The file by find_input(); empty where there is no name.
[[nodiscard]] std::filesystem::path found_or_none(const std::string& name);

/// \param file of the arguments, as it was found \param points of imported layers are read
[[nodiscard]] Job job_of(const JobArguments& arguments, const std::filesystem::path& file,
                         bool points);

[[nodiscard]] RunContext context_of(const Common& common, Progress& progress);

/// Whether to show phases: work of at most a few seconds shows them only on a terminal, since a log
/// needs no lines of them.
[[nodiscard]] bool shows_bar(const Common& common);

[[nodiscard]] double seconds_since(std::chrono::steady_clock::time_point begun);

/// kDone or kCheckFailed. Prints a line on stderr for each failed check, unless the summary showed
/// it on the same terminal.
[[nodiscard]] int exit_code(const std::string& file, const std::vector<Check>& checks,
                            const Common& common);

}  // namespace meshwind
