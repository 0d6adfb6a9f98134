#include "winding/plan/free_fibre.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meshwind {
namespace {

// Smallest step of the search along the fibre: finer than any clearance that is asked for.
constexpr double kStep_mm = 1.0;

// Shortest step along an arm.
constexpr double kArmStep_mm = 3.0;

// Longest step of the search: an arm's far end moves faster than the eye.
constexpr double kLongestStep_mm = 12.0;

// What rounding may take from a distance from the spindle.
constexpr double kRadiusRounding_mm = 1e-6;

// True when the eye, or what of an arm is from there on outward, is known to have room about it.
// Its distance from the spindle does not get less along the arm.
bool has_room(const RayQuery& obstacles, const Eigen::Vector3d& from_mm, double need_mm) {
    const double room_mm = obstacles.room_from_mm(from_mm.z(), need_mm) + kRadiusRounding_mm;
    return from_mm.head<2>().squaredNorm() >= room_mm * room_mm;
}

// Marches along each part of the arm by what is free around it.
bool arm_clear(const RayQuery& obstacles, const FreeFibreRule& rule, const Eigen::Vector3d& eye_mm,
               const Eigen::Vector3d& outward, double more_mm) {
    for (const ArmPart& part : rule.arm) {
        const Eigen::Vector3d front = eye_mm + part.from_mm * outward;
        if (outward.z() == 0.0 && front.dot(outward) >= 0.0 &&
            has_room(obstacles, front, part.radius_mm + rule.clearance_mm + more_mm)) {
            continue;
        }
        for (double along = part.from_mm; along <= part.to_mm;) {
            const double spare = obstacles.distance_estimate_mm(eye_mm + along * outward) -
                                 part.radius_mm - rule.clearance_mm - more_mm;
            if (spare < 0.0) {
                return false;
            }
            along += std::max(spare, kArmStep_mm);
        }
    }
    return true;
}

class Window {
public:
    Window(const RayQuery& obstacles, const Eigen::Vector3d& landing,
           const Eigen::Vector3d& tangent, const FreeFibreRule& rule)
        : obstacles_(obstacles), landing_(landing), tangent_(tangent), rule_(rule) {}

    // With the arm straight away from the spindle; where it is more, the longest step.
    [[nodiscard]] double spare(double length) const {
        const Eigen::Vector3d eye = landing_ + length * tangent_;
        const Eigen::Vector3d outward = Eigen::Vector3d(eye.x(), eye.y(), 0.0).normalized();
        if (has_room(obstacles_, eye,
                     rule_.head_radius_mm + rule_.clearance_mm + kLongestStep_mm)) {
            return arm_clear(obstacles_, rule_, eye, outward, 0.0) ? kLongestStep_mm : -kStep_mm;
        }
        return head_spare_mm(obstacles_, rule_, eye, outward);
    }

    // Appends the clear ranges within [from, to].
    void scan(double from, double to, std::vector<FreeFibreWindow>& windows) const {
        double last_clear = -1.0;
        for (double length = from;;) {
            const double gap = spare(length);
            if (gap >= 0.0 && last_clear < 0.0) {
                windows.push_back({length, length});
            }
            if (gap >= 0.0) {
                windows.back().high_mm = length;
                last_clear = length;
            } else {
                last_clear = -1.0;
            }
            if (length >= to) {
                return;
            }
            length = std::min(to, length + std::clamp(std::abs(gap), kStep_mm, kLongestStep_mm));
        }
    }

private:
    const RayQuery& obstacles_;
    const Eigen::Vector3d& landing_;
    const Eigen::Vector3d& tangent_;
    const FreeFibreRule& rule_;
};

// A way to reach one window of a station: the lengths in it that can be reached, at what cost, and
// from which window of the station before.
struct Reach {
    FreeFibreWindow window;
    double cost = std::numeric_limits<double>::infinity();
    std::size_t before = 0;
};

double distance_to(const FreeFibreWindow& window, double length) {
    return std::max({0.0, window.low_mm - length, length - window.high_mm});
}

// The cheapest way to `window` from those of the station `ds_mm` before; of cost infinity where
// none leads there.
Reach reached_from(std::span<const Reach> before, const FreeFibreWindow& window, double ds_mm,
                   double cost_mm2) {
    Reach best;
    for (std::size_t k = 0; k < before.size(); ++k) {
        const Reach& from = before[k];
        const FreeFibreWindow next{
            std::max(window.low_mm, from.window.low_mm - kShorteningRate * ds_mm),
            std::min(window.high_mm, from.window.high_mm + kLengtheningRate * ds_mm)};
        if (!next.empty() && from.cost + cost_mm2 < best.cost) {
            best = {next, from.cost + cost_mm2, k};
        }
    }
    return best;
}

// One window of each station, and the stations at which the way over them begins: the first, and
// those that cannot be reached.
struct WindowWay {
    std::vector<FreeFibreWindow> window;
    std::vector<char> begins;
};

// The cheapest way over windows that overlap within the rates from station to station, by dynamic
// programming; the cost is the area between windows and the preferred length. Where no window can
// be reached the way begins anew.
WindowWay choose_windows(std::span<const double> s_mm,
                         std::span<const std::vector<FreeFibreWindow>> windows,
                         double preferred_mm) {
    std::vector<std::vector<Reach>> reach(windows.size());
    WindowWay way{std::vector<FreeFibreWindow>(windows.size(), {preferred_mm, preferred_mm}),
                  std::vector<char>(windows.size(), 1)};
    for (std::size_t i = 0; i < windows.size(); ++i) {
        for (const FreeFibreWindow& window : windows[i]) {
            const double ds = i == 0 ? 0.0 : s_mm[i] - s_mm[i - 1];
            const Reach found = i == 0 ? Reach{}
                                       : reached_from(reach[i - 1], window, ds,
                                                      ds * distance_to(window, preferred_mm));
            if (found.cost < std::numeric_limits<double>::infinity()) {
                way.begins[i] = 0;
            }
            reach[i].push_back(found);
        }
        for (std::size_t k = 0; way.begins[i] != 0 && k < windows[i].size(); ++k) {
            reach[i][k] = {windows[i][k], distance_to(windows[i][k], preferred_mm), 0};
        }
    }
    std::size_t k = 0;
    for (std::size_t i = windows.size(); i-- > 0;) {
        if (reach[i].empty()) {
            continue;
        }
        if (i + 1 == windows.size() || way.begins[i + 1] != 0) {
            k = static_cast<std::size_t>(
                std::min_element(reach[i].begin(), reach[i].end(),
                                 [](const Reach& a, const Reach& b) { return a.cost < b.cost; }) -
                reach[i].begin());
        }
        way.window[i] = windows[i][k];
        k = reach[i][k].before;
    }
    return way;
}

}  // namespace

double head_spare_mm(const RayQuery& obstacles, const FreeFibreRule& rule,
                     const Eigen::Vector3d& eye_mm, const Eigen::Vector3d& outward,
                     double more_mm) {
    const double ball =
        obstacles.distance_estimate_mm(eye_mm) - rule.head_radius_mm - rule.clearance_mm - more_mm;
    return ball >= 0.0 && !arm_clear(obstacles, rule, eye_mm, outward, more_mm) ? -kStep_mm : ball;
}

bool is_head_clear(const RayQuery& obstacles, const FreeFibreRule& rule,
                   const Eigen::Vector3d& eye_mm, const Eigen::Vector3d& outward, double more_mm) {
    if (has_room(obstacles, eye_mm, rule.head_radius_mm + rule.clearance_mm + more_mm)) {
        return arm_clear(obstacles, rule, eye_mm, outward, more_mm);
    }
    return head_spare_mm(obstacles, rule, eye_mm, outward, more_mm) >= 0.0;
}

double unobstructed_mm(const RayQuery& obstacles, const Eigen::Vector3d& landing_mm,
                       const Eigen::Vector3d& normal, const Eigen::Vector3d& tangent,
                       const FreeFibreRule& rule) {
    const Eigen::Vector3d origin =
        landing_mm + rule.stand_off_mm * normal + rule.start_mm * tangent;
    return std::min(rule.max_mm,
                    rule.start_mm + obstacles.first_hit_mm(origin, tangent, rule.max_mm));
}

std::vector<FreeFibreWindow> free_fibre_windows(const RayQuery& obstacles,
                                                const Eigen::Vector3d& landing_mm,
                                                const Eigen::Vector3d& normal,
                                                const Eigen::Vector3d& tangent,
                                                const FreeFibreRule& rule) {
    const double longest = unobstructed_mm(obstacles, landing_mm, normal, tangent, rule);
    std::vector<FreeFibreWindow> windows;
    if (longest < rule.min_mm) {
        return windows;
    }
    const Window window(obstacles, landing_mm, tangent, rule);
    const double wish = std::min(std::max(rule.preferred_mm, rule.min_mm), longest);
    window.scan(rule.min_mm, wish, windows);
    if (windows.empty() && longest > wish) {
        window.scan(wish, longest, windows);
    }
    return windows;
}

bool is_free_length(const RayQuery& obstacles, const Eigen::Vector3d& landing_mm,
                    const Eigen::Vector3d& normal, const Eigen::Vector3d& tangent,
                    const FreeFibreRule& rule, double length_mm) {
    return length_mm >= rule.min_mm && length_mm <= rule.max_mm &&
           Window(obstacles, landing_mm, tangent, rule).spare(length_mm) >= 0.0 &&
           unobstructed_mm(obstacles, landing_mm, normal, tangent, rule) >= length_mm;
}

FreeLengths choose_free_lengths(std::span<const double> s_mm,
                                std::span<const std::vector<FreeFibreWindow>> windows,
                                double preferred_mm) {
    const auto [window, begins] = choose_windows(s_mm, windows, preferred_mm);
    FreeLengths lengths;
    std::vector<double>& low = lengths.low_mm;
    std::vector<double>& high = lengths.high_mm;
    for (const FreeFibreWindow& chosen : window) {
        low.push_back(chosen.low_mm);
        high.push_back(chosen.high_mm);
    }
    for (std::size_t i = 1; i < s_mm.size(); ++i) {
        const double ds = s_mm[i] - s_mm[i - 1];
        if (begins[i] == 0) {
            low[i] = std::max(low[i], low[i - 1] - kShorteningRate * ds);
            high[i] = std::min(high[i], high[i - 1] + kLengtheningRate * ds);
        }
    }
    for (std::size_t i = s_mm.size(); i-- > 1;) {
        const double ds = s_mm[i] - s_mm[i - 1];
        if (begins[i] == 0) {
            low[i - 1] = std::max(low[i - 1], low[i] - kLengtheningRate * ds);
            high[i - 1] = std::min(high[i - 1], high[i] + kShorteningRate * ds);
        }
    }
    for (std::size_t i = 0; i < s_mm.size(); ++i) {
        const bool unreached = i > 0 && begins[i] != 0 && !windows[i - 1].empty();
        if (windows[i].empty() || unreached) {
            lengths.blocked.push_back(i);
        }
    }
    return lengths;
}

}  // namespace meshwind
