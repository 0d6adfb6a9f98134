/// From a layer of the job to its plan: which planner, with what options.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cli/job.h"
#include "cli/setup.h"
#include "winding/plan.h"

namespace meshwind {

/// Share of the reachable wall that a plan must cover to count as one.
inline constexpr double kCoveredShare = 0.9;

struct LayerPlanOptions {
    std::uint64_t seed = 1;
    int effort = 1;  ///< how long the plan is improved, as a multiple
    /// What the layers before lie on: hoops lie on its cylinder, elbows keep its line.
    const Mandrel* bare = nullptr;
    double build_up_mm = 0.0;      ///< of the layers before at most
    const Plan* before = nullptr;  ///< of the layer before: its fibre goes on where it can
    /// Winds pieces and winds their program again; returns those that it does not lay as planned.
    std::function<std::vector<std::size_t>(std::span<const Piece>)> refused;
    /// In words what was wrong with those that were refused last.
    std::function<std::string()> why_refused;
    std::function<void(const std::string& step, double share)> progress;
    /// Told in words why courses are planned on a body that has patterns.
    std::function<void(const std::string& why)> no_pattern;
};

/// A cover of a body that has patterns is planned on a job's own account only where the wall is no
/// larger than so many squares of the tow's width: ten times a tee of 0.19 m^2 with a tow of 6 mm,
/// which takes half a minute. The time grows faster than that number.
inline constexpr double kMostTowSquares = 5e4;

/// A plan of the layer on the setup's mandrel. `auto` takes a pattern where the mandrel has one
/// that covers kCoveredShare of it and can be wound, else courses that cover it; where the mandrel
/// has patterns and none is taken `no_pattern` is told why, and a wall of more than
/// kMostTowSquares is not covered. \pre the layer is not imported
[[nodiscard]] Plan plan_layer(const Setup& setup, const LayerJob& layer,
                              const LayerPlanOptions& options);

}  // namespace meshwind
