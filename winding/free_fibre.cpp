#include "winding/free_fibre.h"

#include <algorithm>

namespace meshwind {
namespace {

// Smallest step of the search along the fibre: finer than any clearance that is asked for.
constexpr double kStep_mm = 1.0;

class Window {
public:
    Window(const RayQuery& obstacles, const Eigen::Vector3d& landing,
           const Eigen::Vector3d& tangent, const FreeFibreRule& rule)
        : obstacles_(obstacles),
          landing_(landing),
          tangent_(tangent),
          need_mm_(rule.head_radius_mm + rule.clearance_mm) {}

    // Distance from the head's ball to the next thing, negative where too near; at most `need`.
    [[nodiscard]] double spare(double length) const {
        const Eigen::Vector3d eye = landing_ + length * tangent_;
        return obstacles_.closest(eye, 2.0 * need_mm_).distance_mm - need_mm_;
    }

    // First length from `from` towards `to` whose ball is clear; `to` passed when there is none.
    [[nodiscard]] double find_clear(double from, double to) const {
        const double sign = to >= from ? 1.0 : -1.0;
        double length = from;
        while (sign * (to - length) >= 0.0) {
            const double gap = spare(length);
            if (gap >= 0.0) {
                break;
            }
            length += sign * std::max(-gap, kStep_mm);
        }
        return length;
    }

    // Last length from `from` (clear) towards `to` before the ball is no longer clear.
    [[nodiscard]] double find_end(double from, double to) const {
        const double sign = to >= from ? 1.0 : -1.0;
        double length = from;
        while (sign * (to - length) > 0.0) {
            const double step = std::min(sign * (to - length), std::max(spare(length), kStep_mm));
            if (spare(length + sign * step) < 0.0) {
                return length;
            }
            length += sign * step;
        }
        return to;
    }

private:
    const RayQuery& obstacles_;
    const Eigen::Vector3d& landing_;
    const Eigen::Vector3d& tangent_;
    double need_mm_;
};

}  // namespace

FreeFibreWindow free_fibre_window(const RayQuery& obstacles, const Eigen::Vector3d& landing_mm,
                                  const Eigen::Vector3d& normal, const Eigen::Vector3d& tangent,
                                  const FreeFibreRule& rule) {
    const Eigen::Vector3d origin =
        landing_mm + rule.stand_off_mm * normal + rule.start_mm * tangent;
    const double free = rule.start_mm + obstacles.first_hit_mm(origin, tangent, rule.max_mm);
    const double longest = std::min(rule.max_mm, free);
    if (longest < rule.min_mm) {
        return {};
    }
    const Window window(obstacles, landing_mm, tangent, rule);
    const double wish = std::min(std::max(rule.preferred_mm, rule.min_mm), longest);
    double inside = window.find_clear(wish, rule.min_mm);
    if (inside < rule.min_mm) {
        inside = window.find_clear(wish, longest);
        if (inside > longest) {
            return {};
        }
    }
    return {window.find_end(inside, rule.min_mm), window.find_end(inside, longest)};
}

}  // namespace meshwind
