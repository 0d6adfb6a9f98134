#include "postproc/motion/junction_time.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "core/units.h"

namespace meshwind {
namespace {

using Eigen::VectorXd;

// Corners within this of straight on, or of back, are taken as that; as the firmware has it.
constexpr double kStraight = 0.999999;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Along one block.
struct Stretch {
    double length = 0.0;         // mm and deg together
    double acceleration = 0.0;   // per s^2
    double speed = 0.0;          // wanted, per s
    double entry_squared = 0.0;  // most at its begin
};

// The most along `direction` that no axis passes its own limit.
double most_along(const VectorXd& limit, const VectorXd& direction) {
    double most = kInfinite;
    for (Eigen::Index a = 0; a < direction.size(); ++a) {
        if (direction[a] != 0.0) {
            most = std::min(most, limit[a] / std::abs(direction[a]));
        }
    }
    return most;
}

// Square of the speed at a corner. \param before, after unit
double corner_squared(const VectorXd& before, const VectorXd& after, const VectorXd& acceleration,
                      double deviation) {
    const double cosine = -before.dot(after);
    if (cosine > kStraight) {
        return 0.0;
    }
    if (cosine < -kStraight) {
        return kInfinite;
    }
    const double half_sine = std::sqrt(0.5 * (1.0 - cosine));
    return most_along(acceleration, (after - before).normalized()) * deviation * half_sine /
           (1.0 - half_sine);
}

// Time over a stretch from one speed to another, both squared.
double time_s(const Stretch& stretch, double from_squared, double to_squared) {
    const double a = stretch.acceleration;
    const double top_squared = std::min(stretch.speed * stretch.speed,
                                        0.5 * (from_squared + to_squared) + a * stretch.length);
    const double top = std::sqrt(top_squared);
    const double ramps = (2.0 * top_squared - from_squared - to_squared) / (2.0 * a);
    return (2.0 * top - std::sqrt(from_squared) - std::sqrt(to_squared)) / a +
           std::max(0.0, stretch.length - ramps) / top;
}

}  // namespace

std::vector<double> junction_times_s(const Machine& machine, const BlockList& list,
                                     const JunctionPlanner& planner) {
    const std::size_t axes = list.axes.size();
    VectorXd velocity(static_cast<Eigen::Index>(axes));
    VectorXd acceleration(velocity.size());
    for (std::size_t a = 0; a < axes; ++a) {
        const Axis& axis = machine.axis(a);
        const double unit = axis.type == AxisType::Rotary ? deg_from_rad(1.0) : 1.0;
        velocity[static_cast<Eigen::Index>(a)] = axis.velocity * unit;
        acceleration[static_cast<Eigen::Index>(a)] = axis.acceleration * unit;
    }
    std::vector<Stretch> stretches;
    std::vector<std::size_t> block_of;
    VectorXd last;
    for (std::size_t b = 1; b < list.blocks.size(); ++b) {
        VectorXd way(velocity.size());
        for (std::size_t a = 0; a < axes; ++a) {
            way[static_cast<Eigen::Index>(a)] = list.value(b, a) - list.value(b - 1, a);
        }
        Stretch stretch{.length = way.norm()};
        if (!(stretch.length > 0.0) || !(list.blocks[b].duration_s > 0.0)) {
            continue;
        }
        const VectorXd direction = way / stretch.length;
        stretch.acceleration = most_along(acceleration, direction);
        stretch.speed =
            std::min(stretch.length / list.blocks[b].duration_s, most_along(velocity, direction));
        if (!stretches.empty()) {
            const double slower = std::min(stretch.speed, stretches.back().speed);
            stretch.entry_squared =
                std::min(slower * slower,
                         corner_squared(last, direction, acceleration, planner.deviation_mm));
        }
        last = direction;
        stretches.push_back(stretch);
        block_of.push_back(b);
    }
    std::vector<double> times(list.blocks.size(), 0.0);
    double squared = 0.0;  // of the speed
    for (std::size_t k = 0; k < stretches.size(); ++k) {
        // At the end of the last block that is known it would have to stand.
        double end_squared = 0.0;
        for (std::size_t i = std::min(stretches.size(), k + planner.blocks); i-- > k + 1;) {
            const Stretch& next = stretches[i];
            end_squared =
                std::min(next.entry_squared, end_squared + 2.0 * next.acceleration * next.length);
        }
        const Stretch& here = stretches[k];
        end_squared = std::min(end_squared, squared + 2.0 * here.acceleration * here.length);
        times[block_of[k]] = time_s(here, squared, end_squared);
        squared = end_squared;
    }
    return times;
}

}  // namespace meshwind
