/// From a layer of the job to its plan: which planner, with what options.
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
    /// What the layers before lie on: hoops lie on its cylinder, elbows keep its line.
    const Mandrel* bare = nullptr;
    double build_up_mm = 0.0;      ///< of the layers before at most
    const Plan* before = nullptr;  ///< of the layer before: its fibre goes on where it can
    double least_covered = 0.0;    ///< as in CoverOptions
    double least_joined = 0.0;     ///< as in CoverOptions
    /// Where a part has patterns and none holds, courses do not cover it instead: the plan fails.
    /// So it does, before it is wound, where none covers least_covered of the wall.
    bool patterns_first = false;
    const StageAsk* stage = nullptr;  ///< of a layer of kind Wall
    std::vector<PinStand> pins{};     ///< that courses turn on, by rim; empty: by friction
};

/// A cover of a body that has patterns is planned on a job's own account only where the wall is no
/// larger than so many squares of the tow's width: ten times a tee of 0.19 m^2 with a tow of 6 mm,
/// which takes half a minute. The time grows faster than that number.
inline constexpr double kMaxTowSquares = 5e4;

struct PlannedLayer {
    Plan plan;
    std::unique_ptr<TrialWinding> trial;  ///< of this plan, where it was wound and held
    std::string no_pattern;  ///< in words why courses cover a part that has patterns; else empty
};

/// A plan of the layer on the setup's mandrel, by the planners of layer_planners.h. `auto` takes a
/// pattern where the part has one that covers kCoveredShare of it and that the machine winds, else
/// courses that cover it; where the part has patterns and none is taken the context is told why,
/// and a wall of more than kMaxTowSquares is not covered. A stage of a wall is a pattern, as of
/// `auto`, while most of the wall asks for more, else a cover. \pre the layer is not imported
[[nodiscard]] PlannedLayer plan_layer(const Setup& setup, const LayerJob& layer,
                                      const Windability& machine,
                                      const LayerPlanOptions& options = {});

/// Share of the wall that a plan has to cover: all but `bare` of what its fibres can join, or of
/// kCoveredShare of what courses reach where that is more.
[[nodiscard]] double least_covered(const Coverage& coverage, double bare);

/// Whether pins have to stand before the layer is planned: where courses cover the part and turn on
/// them. Those of a pattern follow from it.
[[nodiscard]] bool needs_pins_first(const Setup& setup, const LayerJob& layer,
                                    const LayerPlanOptions& options = {});

}  // namespace meshwind
