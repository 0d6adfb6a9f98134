#include "machines/eye_range.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/units.h"
#include "machines/arm_eye_inverse.h"
#include "machines/eye_inverse.h"

namespace meshwind {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

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

    void hold(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }

    [[nodiscard]] double nearest_to_zero() const { return std::max({low, -high, 0.0}); }
    [[nodiscard]] double farthest_from_zero() const {
        return std::max(std::abs(low), std::abs(high));
    }
};

constexpr Interval kNone{std::numeric_limits<double>::infinity(),
                         -std::numeric_limits<double>::infinity()};

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

// A robot's reach is looked up in steps of this, from these sides: farther round a mandrel is not
// turned away from the central angle.
constexpr double kReachStep_mm = 80.0;
constexpr std::array<double, 5> kSides_rad = {-kPi / 3.0, -kPi / 6.0, 0.0, kPi / 6.0, kPi / 3.0};

// Farther than its links are long altogether an arm does not reach from its foot.
double length_mm(const Machine& arm) {
    double length = 0.0;
    for (std::size_t i = 0; i < arm.eye_chain.size(); ++i) {
        const bool last = i + 1 == arm.eye_chain.size();
        const Vector3d& next = last ? arm.eye.position_mm : arm.eye_chain[i + 1].point_mm;
        length += (next - arm.eye_chain[i].point_mm).norm();
    }
    return length;
}

// What of a grid an arm without a track reaches, and a step more; machine frame.
EyeRange range_of_arm(const Machine& machine, double within_mm) {
    const std::unique_ptr<ArmEyeInverse> arm = ArmEyeInverse::recognise(machine);
    const auto reaches = [&](double from_axis_mm, double z_mm) {
        return std::any_of(kSides_rad.begin(), kSides_rad.end(), [&](double side_rad) {
            return arm->reaches(
                {from_axis_mm * std::cos(side_rad), from_axis_mm * std::sin(side_rad), z_mm});
        });
    };
    const Vector3d& foot = machine.eye_chain.front().point_mm;
    const double reach_mm = length_mm(machine);
    const double most_mm = reach_mm + foot.head<2>().norm();
    Interval height = kNone;
    Interval height_within = kNone;
    Interval distance = kNone;
    for (double z = foot.z() - reach_mm; z <= foot.z() + reach_mm; z += kReachStep_mm) {
        for (double from_axis = 0.0; from_axis <= most_mm; from_axis += kReachStep_mm) {
            if (reaches(from_axis, z)) {
                height.hold(z);
                distance.hold(from_axis);
                if (from_axis <= within_mm) {
                    height_within.hold(z);
                }
            }
        }
    }
    if (height_within.low <= height_within.high) {
        height = height_within;
    }
    EyeRange range;
    range.low_mm = height.low - kReachStep_mm;
    range.high_mm = height.high + kReachStep_mm;
    range.nearest_mm = std::max(0.0, distance.low - kReachStep_mm);
    range.farthest_mm = distance.high + kReachStep_mm;
    return range;
}

// Its letters along and across are those of all its axes.
EyeRange range_of_robot(Machine machine, double within_mm) {
    const bool tracked = machine.eye_chain.front().type == AxisType::Linear;
    const Axis track = machine.eye_chain.front();
    if (tracked) {
        machine.eye_chain.erase(machine.eye_chain.begin());
    }
    EyeRange range = range_of_arm(machine, within_mm);
    Interval height{range.low_mm, range.high_mm};
    if (tracked) {
        height.add(track, track.direction.z());
        range.along += track.letter;
    }
    for (const Axis& axis : machine.eye_chain) {
        range.along += axis.letter;
        range.across += axis.letter;
    }
    const double mount_mm = machine.mount ? machine.mount->origin_mm.z() : 0.0;
    range.low_mm = height.low - mount_mm;
    range.high_mm = height.high - mount_mm;
    return range;
}

}  // namespace

std::optional<EyeRange> eye_range(const Machine& machine, double within_mm) {
    const MachineClass what = machine_class(machine);
    if (what.arm) {
        return range_of_robot(machine, within_mm);
    }
    if (!what.closed_form) {
        return std::nullopt;
    }
    EyeRange range;
    const std::vector<const Axis*> axes = linear_axes(machine);
    const Vector3d& eye = machine.eye.position_mm;
    const double mount_mm = machine.mount ? machine.mount->origin_mm.z() : 0.0;
    find_heights(axes, eye.z() - mount_mm, range);
    find_distances(axes, eye.head<2>(), range);
    return range;
}

}  // namespace meshwind
