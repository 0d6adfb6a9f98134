#include "machines/eye_range.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "machines/eye_inverse.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;

// Directions are unit vectors: less than this of one is rounding.
constexpr double kNothing = 1e-9;

std::vector<const Axis*> linear_axes(const Machine& machine) {
    std::vector<const Axis*> axes;
    for (const Axis& axis : machine.eye_chain) {
        if (axis.type == AxisType::Linear) {
            axes.push_back(&axis);
        }
    }
    return axes;
}

struct Interval {
    double low;
    double high;

    // With an axis that adds `share` of its travel.
    void add(const Axis& axis, double share) {
        if (std::abs(share) > kNothing) {
            low += share > 0.0 ? share * axis.min : share * axis.max;
            high += share > 0.0 ? share * axis.max : share * axis.min;
        }
    }

    [[nodiscard]] double nearest_to_zero() const { return std::max({low, -high, 0.0}); }
    [[nodiscard]] double farthest_from_zero() const {
        return std::max(std::abs(low), std::abs(high));
    }
};

void find_heights(const std::vector<const Axis*>& axes, double zero_mm, EyeRange& range) {
    Interval height{zero_mm, zero_mm};
    for (const Axis* axis : axes) {
        const double share = axis->direction.z();
        height.add(*axis, share);
        if (std::abs(share) > kNothing) {
            range.along += axis->letter;
            range.along_scale = 1.0 / share;
            range.along_zero_mm = -zero_mm / share;
        }
    }
    range.low_mm = height.low;
    range.high_mm = height.high;
}

// Distance of the origin from the stretch that one axis moves the eye over.
double nearest_on_line(const Axis& axis, const Vector2d& zero_mm) {
    const Vector2d direction = axis.direction.head<2>();
    const double foot = -zero_mm.dot(direction) / direction.squaredNorm();
    return (zero_mm + std::clamp(foot, axis.min, axis.max) * direction).norm();
}

void find_distances(const std::vector<const Axis*>& axes, const Vector2d& zero_mm,
                    EyeRange& range) {
    Interval x{zero_mm.x(), zero_mm.x()};
    Interval y{zero_mm.y(), zero_mm.y()};
    const Axis* across = nullptr;
    for (const Axis* axis : axes) {
        if (axis->direction.head<2>().norm() > kNothing) {
            x.add(*axis, axis->direction.x());
            y.add(*axis, axis->direction.y());
            range.across += axis->letter;
            across = axis;
        }
    }
    range.nearest_mm = range.across.size() == 1
                           ? nearest_on_line(*across, zero_mm)
                           : std::hypot(x.nearest_to_zero(), y.nearest_to_zero());
    range.farthest_mm = std::hypot(x.farthest_from_zero(), y.farthest_from_zero());
    if (range.across.size() == 1 && std::isfinite(across->min) && std::isfinite(across->max)) {
        const Vector2d direction = across->direction.head<2>();
        range.farthest_mm = std::max((zero_mm + across->min * direction).norm(),
                                     (zero_mm + across->max * direction).norm());
    }
}

}  // namespace

std::optional<EyeRange> eye_range(const Machine& machine) {
    if (!machine_class(machine).closed_form) {
        return std::nullopt;
    }
    EyeRange range;
    const std::vector<const Axis*> axes = linear_axes(machine);
    const Eigen::Vector3d& eye = machine.eye.position_mm;
    const double mount_mm = machine.mount ? machine.mount->origin_mm.z() : 0.0;
    find_heights(axes, eye.z() - mount_mm, range);
    find_distances(axes, eye.head<2>(), range);
    return range;
}

}  // namespace meshwind
