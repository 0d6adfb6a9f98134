/// The main job: mandrel, machine and job in; plan, program and checks out. No file is read or
/// written.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/run_context.h"
#include "machines/machine.h"
#include "mesh/mandrel.h"
#include "pipeline/imported_plan.h"
#include "pipeline/job/job.h"
#include "pipeline/setup.h"
#include "pipeline/wall/wall_stages.h"
#include "pipeline/wind_layer.h"
#include "postproc/verify/verify.h"

namespace meshwind {

struct WindOptions {
    RunContext context{};
    /// Landing points to wind instead of the job's layers.
    std::optional<ImportRequest> import{};
    bool force = false;  ///< release the program although a check failed
    InputFiles files{};  ///< named in messages
    /// Digest of the mandrel's file in the programs' heads, "sha256/128 ..."; empty: digest of its
    /// mesh.
    std::string mandrel_digest{};
    double reading_s = 0.0;  ///< time spent on reading the inputs before; counts as "import"
    /// A cover of less than this share of the wall that courses reach is not wound: its plan fails.
    double least_covered = 0.0;
    /// Nor one whose fibres can join less than this share of the wall.
    double least_joined = 0.0;
    /// Where a part has patterns and none holds, the plan fails instead of covering it by courses.
    /// It also fails, before it is wound, where none covers least_covered of the wall.
    bool patterns_first = false;
};

/// A layer of the job that was wound in stages.
struct WoundWall {
    std::size_t first = 0;  ///< of Run::layers, to `last` inclusive
    std::size_t last = 0;
    WallFigures figures{};
    std::vector<std::int32_t> asked_of_faces;  ///< layers, per triangle of the bare mandrel
};

/// The result of the main job.
struct Run {
    std::vector<WoundLayer> layers;  ///< >= 1, in winding order, as far as they could be wound
    /// Checks of all layers: those of a further layer end in its number, "slip-layer-2".
    std::vector<Check> checks;
    std::vector<std::string> remarks;  ///< inputs that may be meant otherwise, one line each
    std::map<std::string, double> timing_s;
    std::vector<WoundWall> walls;  ///< of the job's layers of kind Wall
    std::uint64_t seed = 1;
    double effort = 1.0;
    std::string job = "{}";  ///< as told_job_text()
    bool complete = false;   ///< every layer of the job was reached
    bool usable = false;     ///< the programs may be run: all was planned and passed, or forced

    /// Whether every layer of the job has a plan.
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

/// Plans every layer of the job, makes its programs and winds them again from their text.
/// \param mandrel from load_mandrel(), with mandrel_options(job) \param machine from load_machine()
/// \throws InputError for input that cannot be wound at all; failures of a plan are failed checks
/// of the result
[[nodiscard]] Run wind(Mandrel mandrel, const Machine& machine, const Job& job,
                       const WindOptions& options = {});

/// The job's mandrel, read with the blend that the job has: for tries (trials/trials.h).
using MandrelOf = std::function<Mandrel(const Job& job)>;

}  // namespace meshwind
