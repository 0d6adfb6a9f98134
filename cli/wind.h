/// The main job: mandrel, machine and job in; plan, program and report out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/imported_plan.h"
#include "cli/wind_layer.h"
#include "postproc/verify.h"

namespace meshwind {

struct WindRequest {
    std::filesystem::path mandrel;
    std::filesystem::path machine;
    std::filesystem::path job;  ///< empty: the defaults
    std::filesystem::path out = "meshwind-out";
    double unit_mm = 0.0;  ///< overrides the job's units where > 0
    /// Landing points to wind instead of what the job's layers ask for.
    std::optional<ImportRequest> import;
    std::uint64_t seed = 1;
    int effort = 1;      ///< how long the plan is improved, as a multiple
    bool force = false;  ///< write the program although a check failed
    std::function<void(const std::string& step, double share)> progress;
    /// Told at once what whoever waits should know, a line each.
    std::function<void(const std::string& words)> remark{};
};

/// Everything that was found, for the report.
struct WindResult {
    std::vector<WoundLayer> layers;  ///< >= 1, in winding order, as far as they could be wound
    /// Of all layers: those of a further one end in its number, "slip-layer-2".
    std::vector<Check> checks;
    std::vector<std::string> remarks;  ///< what may be meant otherwise, one line each
    std::map<std::string, double> timing_s;
    bool program_written = false;

    /// Every layer that the job asks for has a plan.
    [[nodiscard]] bool planned() const;

    [[nodiscard]] bool passed() const {
        for (const Check& check : checks) {
            if (!check.ok) {
                return false;
            }
        }
        return true;
    }
};

/// Runs the job and writes the output folder, whole or not at all: path.csv, motion.csv,
/// report.json, lay-up and fibre (layup_files.h), and the program if every check passed or `force`
/// is set. Each further layer and fibre has program, path, motion and fibre of its own, each
/// further layer its mandrel (run_files.h). \throws InputError, IoError for input that cannot be
/// used; nothing is written then
[[nodiscard]] WindResult wind(const WindRequest& request);

}  // namespace meshwind
