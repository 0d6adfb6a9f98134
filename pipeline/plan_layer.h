/// Plans a layer of the job: choice of planner and its options.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/run_context.h"
#include "pipeline/job/job.h"
#include "pipeline/setup.h"
#include "winding/laminate/stage_ask.h"
#include "winding/plan/windability.h"
#include "winding/turn/course_turns.h"

namespace meshwind {

struct LayerPlanOptions {
    RunContext context{};
    /// Mandrel under the layers before: hoops lie on its cylinder, elbows keep its line.
    const Mandrel* bare = nullptr;
    double build_up_mm = 0.0;  ///< of the layers before at most
    const Plan* before =
        nullptr;  ///< plan of the layer before: its fibre is continued where possible
    double least_covered = 0.0;  ///< as in CoverOptions
    double least_joined = 0.0;   ///< as in CoverOptions
    /// Where a part has patterns and none holds, the plan fails instead of covering it by courses.
    /// It also fails, before it is wound, where none covers least_covered of the wall.
    bool patterns_first = false;
    const StageAsk* stage = nullptr;  ///< of a layer of kind Wall
    std::vector<PinStand> pins{};     ///< that courses turn on, by rim; empty: by friction
};

/// Largest wall, in squares of the tow's width, on which a cover of a body that has patterns is
/// planned unasked: ten times a tee of 0.19 m^2 with a tow of 6 mm, which takes half a minute. The
/// time grows faster than that number.
inline constexpr double kMaxTowSquares = 5e4;

struct PlannedLayer {
    Plan plan;
    std::unique_ptr<TrialWinding> trial;  ///< trial of this plan, where it was wound and held
    std::string no_pattern;  ///< why courses cover a part that has patterns, in words; else empty
};

/// A plan of the layer on the setup's mandrel, by the planners of layer_planners.h. `auto` takes a
/// pattern where the part has one that covers kCoveredShare of it and that the machine winds, else
/// courses that cover it; where the part has patterns and none is taken, the context is told why,
/// and a wall of more than kMaxTowSquares is not covered. A stage of a wall is a pattern, as for
/// `auto`, while most of the wall needs more, else a cover. \pre the layer is not imported
[[nodiscard]] PlannedLayer plan_layer(const Setup& setup, const LayerJob& layer,
                                      const Windability& machine,
                                      const LayerPlanOptions& options = {});

/// Share of the wall that a plan has to cover: all but `bare` of the share that its fibres can
/// join, or of kCoveredShare of the share that courses reach where that is more.
[[nodiscard]] double least_covered(const Coverage& coverage, double bare);

/// Whether pins have to be placed before the layer is planned: where courses cover the part and
/// turn on them. The pins of a pattern follow from it.
[[nodiscard]] bool needs_pins_first(const Setup& setup, const LayerJob& layer,
                                    const LayerPlanOptions& options = {});

}  // namespace meshwind
