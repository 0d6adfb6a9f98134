/// Winds one layer: its plan, its programs and their checks.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/run_context.h"
#include "pipeline/imported_plan.h"
#include "pipeline/job/job.h"
#include "pipeline/layer_machine.h"
#include "pipeline/setup.h"
#include "postproc/verify/verify.h"
#include "winding/laminate/stage_ask.h"
#include "winding/plan/plan.h"

namespace meshwind {

struct WoundLayer {
    LayerJob job;
    Setup setup;  ///< its mandrel is grown by the layers before
    Plan plan;
    std::string no_pattern;  ///< why courses cover a body that has patterns, in words; else empty
    std::optional<ImportFit> import;     ///< of landing points
    std::vector<FibreProgram> programs;  ///< one for each fibre of the plan
    std::vector<Check> checks;  ///< of the plan, then of each program: those of a further fibre end
                                ///< in its number, "slip-2"
    /// Thickness added by this layer, per vertex of the mandrel's surface; empty where it is the
    /// only one.
    std::vector<double> build_up_mm;

    [[nodiscard]] double duration_s() const;
};

struct WindLayerOptions {
    std::string suffix;  ///< in names of files: "", "-layer-2"
    /// Content of every program's head: version, mandrel, digests.
    ProgramHeader header;
    /// Landing points to wind instead of the layer's own plan.
    std::optional<ImportRequest> import;
    const WoundLayer* before = nullptr;  ///< none for the first
    const Mandrel* bare = nullptr;       ///< under all layers; none for the first
    double build_up_mm = 0.0;            ///< of the layers before at most
    double least_covered = 0.0;          ///< as in CoverOptions
    double least_joined = 0.0;           ///< as in CoverOptions
    bool patterns_first = false;         ///< as in LayerPlanOptions
    const StageAsk* stage = nullptr;     ///< of a layer of kind Wall
    RunContext context{};
    std::function<void(const char* stage)> stage_done;  ///< "plan", "post", "verify"
};

/// Plans the layer on its setup's mandrel, makes the programs and winds them again. A failure is a
/// failed check: "plan" where there is no plan.
/// \param layer has job and setup; the rest is filled in
/// \throws InputError what import_plan and dialects throw
void wind_layer(WoundLayer& layer, const WindLayerOptions& options);

}  // namespace meshwind
