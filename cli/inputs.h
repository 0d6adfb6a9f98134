/// What several commands do with the words of the command line, and with what came of them.
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

/// Of --units; 0 where it is not given, or auto.
[[nodiscard]] double unit_mm(const std::string& name);

/// Three numbers, "X,Y,Z". \param option that has them, for the words
/// \throws InputError cli.vector
[[nodiscard]] Eigen::Vector3d vector_of(const std::string& option, const std::string& text);

/// As find_input(); empty where there is no name.
[[nodiscard]] std::filesystem::path found_or_none(const std::string& name);

/// \param file of the arguments, as it was found \param points of imported layers are read
[[nodiscard]] Job job_of(const JobArguments& arguments, const std::filesystem::path& file,
                         bool points);

[[nodiscard]] RunContext context_of(const Common& common, Progress& progress);

/// What takes seconds at most tells of its phases on a terminal alone: a log needs no line of them.
[[nodiscard]] bool shows_bar(const Common& common);

[[nodiscard]] double seconds_since(std::chrono::steady_clock::time_point begun);

/// Done, or that a check failed. A line on stderr for each of these, unless the summary has told it
/// on the same terminal.
[[nodiscard]] int exit_code(const std::string& file, const std::vector<Check>& checks,
                            const Common& common);

}  // namespace meshwind
