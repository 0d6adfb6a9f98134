/// Limits that set the time of a motion, with their stretches.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace meshwind {

/// Neighbouring steps that one limit set, those that take no time between them included.
struct BindingStretch {
    std::size_t first = 0;
    std::size_t last = 0;
    double time_s = 0.0;
};

/// A limit that set the duration of steps.
struct BindingLimit {
    std::string name;     ///< "fibre", "corner", "C velocity", "C acceleration", "C jerk" ...
    double time_s = 0.0;  ///< total duration of the steps that it set
    std::vector<BindingStretch> stretches;  ///< the longest three, longest first
};

/// A step of a path, its duration and the number of the limit that set it.
struct LimitedStep {
    std::size_t step = 0;
    double duration_s = 0.0;
    std::size_t limit = 0;
};

/// \param name_of the name of a limit \return longest first; only limits that took time
[[nodiscard]] std::vector<BindingLimit> binding_limits(
    std::span<const LimitedStep> steps, const std::function<std::string(std::size_t)>& name_of);

}  // namespace meshwind
