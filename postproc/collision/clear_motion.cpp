#include "postproc/collision/clear_motion.h"

#include <algorithm>
#include <utility>

namespace meshwind {
namespace {

// Stations between two of a path.
std::vector<std::size_t> hits_within(const MotionCheck& check, const EyePath& stations,
                                     std::size_t first, std::size_t last) {
    const EyePath part(stations.begin() + static_cast<std::ptrdiff_t>(first),
                       stations.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    AxisPath axes;
    axes.path = refine_path(check.machine, part, RedundancyPolicy::Chosen, check.tolerance);
    axes.joints = solve_joints(check.machine, axes.path, RedundancyPolicy::Chosen);
    CollisionRule rule = check.rule;
    rule.report_within_mm = rule.clearance_mm;
    return hit_stations(axes,
                        check_collisions(check.machine, check.envelope, check.obstacles, axes.path,
                                         axes.joints, rule),
                        stations);
}

}  // namespace

Improvement improvement_of(const MotionCheck& check, double fibre_speed_mm_s, EyeRule rule,
                           const EyePathResult& eyes) {
    EyePath safe = eyes.path;
    const std::vector<double> central = spindle_turns(safe, RedundancyPolicy::CentralAngle);
    for (std::size_t i = 0; i < safe.size(); ++i) {
        safe[i].turn_rad = central[i];
    }
    std::vector<double> ahead_mm = eyes.ahead_mm;
    std::optional<RepeatedPath> repeated = repetition_of(safe, ahead_mm);
    if (repeated) {
        safe = repeated->few();
        ahead_mm = repeated->few_ahead_mm();
    }
    return {MotionImprover(check.machine, check.obstacles, check.rule.free_fibre, fibre_speed_mm_s,
                           rule != EyeRule::Adaptive, std::move(safe), std::move(ahead_mm)),
            std::move(repeated)};
}

EyePath improved(const Improvement& improvement, EyePath stations) {
    return improvement.repeated
               ? improvement.repeated->all(std::move(stations), improvement.improver.path())
               : improvement.improver.path();
}

std::vector<std::size_t> of_improver(const Improvement& improvement,
                                     std::vector<std::size_t> stations) {
    if (improvement.repeated) {
        for (std::size_t& station : stations) {
            station = improvement.repeated->few_of(station);
        }
        std::sort(stations.begin(), stations.end());
        stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
    }
    return stations;
}

std::size_t station_of(std::int32_t piece, std::int32_t point, const EyePath& stations) {
    const auto at = std::lower_bound(
        stations.begin(), stations.end(), std::pair(piece, point),
        [](const EyePoint& a, const auto& key) { return std::pair(a.piece, a.point) < key; });
    return std::min(static_cast<std::size_t>(at - stations.begin()), stations.size() - 1);
}

std::vector<std::size_t> hit_stations(const AxisPath& axes, const CollisionReport& report,
                                      const EyePath& stations) {
    std::vector<std::size_t> found;
    const auto add = [&](std::size_t point) {
        found.push_back(station_of(axes.path[point].piece, axes.path[point].point, stations));
    };
    for (const auto* const hits : {&report.fibre_hits, &report.head_hits, &report.body_hits}) {
        std::for_each(hits->begin(), hits->end(), add);
    }
    for (const LimitViolation& violation : axes.joints.violations) {
        add(violation.point);
    }
    return found;
}

std::vector<std::size_t> hits_of_change(const MotionCheck& check, const MotionImprover& improver) {
    std::vector<std::size_t> hits;
    for (const auto& [first, last] : improver.changed()) {
        const std::vector<std::size_t> found = hits_within(check, improver.path(), first, last);
        hits.insert(hits.end(), found.begin(), found.end());
    }
    return hits;
}

}  // namespace meshwind
