/// Origin of a program in its head: mandrel, machine and job, so that its text alone is enough to
/// wind it again, to verify it or to resume it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshwind {

struct ProgramHeader;

/// The main job that made a program, besides machine and job.
struct MainJobRun {
    std::string mandrel;  ///< file name of the bare mandrel
    std::uint64_t seed = 1;
    double effort = 1.0;

    bool operator==(const MainJobRun&) const = default;
};

struct MadeFrom {
    std::string version;         ///< of meshwind
    std::string mandrel;         ///< file name of what the program winds on
    std::string mandrel_digest;  ///< e.g. "sha256/128 1f2e.."; empty: not told
    std::string machine_file;    ///< its name
    std::string job;             ///< JSON; empty: not told
    std::string code_digest;
    std::optional<MainJobRun> run;  ///< none: the main job did not make it
};

/// Adds the comments for ProgramHeader's machine_file, run and job; the job takes as many as it
/// needs. \param width characters of a comment
void append_made_from(std::vector<std::string>& comments, const ProgramHeader& header,
                      std::size_t width);

/// Reads a head of any of our dialects. Nothing where the text is not by meshwind. Missing comments
/// leave fields empty; a job that is no JSON is left to its reader.
[[nodiscard]] std::optional<MadeFrom> made_from(std::string_view program);

}  // namespace meshwind
