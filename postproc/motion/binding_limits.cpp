#include "postproc/motion/binding_limits.h"

#include <algorithm>
#include <map>
#include <utility>

namespace meshwind {
namespace {

constexpr std::size_t kMaxStretches = 3;

}  // namespace

std::vector<BindingLimit> binding_limits(std::span<const LimitedStep> steps,
                                         const std::function<std::string(std::size_t)>& name_of) {
    std::map<std::size_t, BindingLimit> limits;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const LimitedStep& step = steps[i];
        BindingLimit& limit = limits[step.limit];
        if (i == 0 || step.limit != steps[i - 1].limit) {
            limit.stretches.push_back({step.step, step.step, 0.0});
        }
        limit.stretches.back().last = step.step;
        limit.stretches.back().time_s += step.duration_s;
        limit.time_s += step.duration_s;
    }
    const auto longer = [](const auto& a, const auto& b) { return a.time_s > b.time_s; };
    std::vector<BindingLimit> binding;
    for (auto& [number, limit] : limits) {
        if (limit.time_s > 0.0) {
            limit.name = name_of(number);
            std::stable_sort(limit.stretches.begin(), limit.stretches.end(), longer);
            limit.stretches.resize(std::min(limit.stretches.size(), kMaxStretches));
            binding.push_back(std::move(limit));
        }
    }
    std::stable_sort(binding.begin(), binding.end(), longer);
    return binding;
}

}  // namespace meshwind
