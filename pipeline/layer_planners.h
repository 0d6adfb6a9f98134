/// The planners of a layer, by kind and shape of the part.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "mesh/revolution/revolution.h"
#include "mesh/tube/tube.h"
#include "pipeline/plan_layer.h"
#include "winding/plan/tow.h"

namespace meshwind {

/// A layer to be planned, with the shape of its part, found on demand.
struct LayerTask {
    const Setup& setup;
    const LayerJob& layer;
    const Windability& machine;
    const LayerPlanOptions& options;

    mutable std::optional<RevolutionFinding> found_revolution{};
    mutable std::optional<TubeFinding> found_tube{};

    [[nodiscard]] const RevolutionFinding& revolution() const;
    /// Layers follow the bare tube's line, whatever shape they have.
    [[nodiscard]] const TubeFinding& tube() const;
};

struct LayerPlanner {
    Planner planner;
    /// Whether it plans layers of this kind, not `auto`.
    bool (*makes)(LayerKind kind);
    /// Empty where the part has the shape for it, else what it lacks, in words.
    std::string (*why_not)(const LayerTask& task);
    /// \pre the part has the shape for it. For `auto` the plan covers kCoveredShare or fails.
    TriedPlan (*plan)(const LayerTask& task);
};

/// In the order in which `auto` tries them; the last one fits every part.
[[nodiscard]] std::span<const LayerPlanner> layer_planners();

}  // namespace meshwind
