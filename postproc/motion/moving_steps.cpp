#include "postproc/motion/moving_steps.h"

#include <cmath>

#include "machines/kinematics.h"

namespace meshwind {
namespace {

// At rest, so far.
void add_step(MovingSteps& steps, std::size_t step, double least_s, std::size_t limit) {
    steps.step.push_back(step);
    steps.least_s.push_back(least_s);
    steps.least_of.push_back(limit);
    steps.move.resize(steps.move.size() + steps.groups, AxisLanes::Zero());
}

// A step of the path, unless nothing moves in it.
void add_moving_step(MovingSteps& steps, const Machine& machine, const JointPath& joints,
                     std::size_t step, double fibre_s) {
    double least_s = fibre_s;
    std::size_t limit = kFibreLimit;
    const auto move = [&](std::size_t a) { return joints.row(step)[a] - joints.row(step - 1)[a]; };
    for (std::size_t a = 0; a < steps.axes; ++a) {
        const double axis_s = std::abs(move(a)) / machine.axis(a).velocity;
        limit = axis_s > least_s ? limit_index(AxisLimit::Velocity, a) : limit;
        least_s = std::max(least_s, axis_s);
    }
    if (least_s <= 0.0) {
        return;
    }
    add_step(steps, step, least_s, limit);
    AxisLanes* const moves = &steps.move[steps.move.size() - steps.groups];
    for (std::size_t a = 0; a < steps.axes; ++a) {
        moves[a / kAxisLanes][static_cast<Eigen::Index>(a % kAxisLanes)] =
            move(a) / machine.axis(a).acceleration;
    }
}

AxisRamps axis_ramps(const Machine& machine, std::size_t axes, std::size_t groups) {
    AxisRamps ramps;
    ramps.build_up_s.assign(groups, AxisLanes::Zero());
    for (std::size_t a = 0; a < axes; ++a) {
        const Axis& axis = machine.axis(a);
        ramps.build_up_s[a / kAxisLanes][static_cast<Eigen::Index>(a % kAxisLanes)] =
            axis.acceleration / axis.jerk;
        ramps.limited_jerk = ramps.limited_jerk || !std::isinf(axis.jerk);
    }
    return ramps;
}

std::vector<AxisLanes> linear_mm_s2(const Machine& machine, std::size_t axes, std::size_t groups) {
    std::vector<AxisLanes> linear(groups, AxisLanes::Zero());
    for (std::size_t a = 0; a < axes; ++a) {
        const Axis& axis = machine.axis(a);
        if (axis.type == AxisType::Linear) {
            linear[a / kAxisLanes][static_cast<Eigen::Index>(a % kAxisLanes)] =
                axis.acceleration / 8.0;
        }
    }
    return linear;
}

// How ramps move the eye at each corner.
std::vector<AxisLanes> eye_mm_s2(const Machine& machine, const JointPath& joints,
                                 const MovingSteps& steps) {
    std::vector<AxisLanes> eye((steps.count + 1) * steps.groups * 3, AxisLanes::Zero());
    for (std::size_t m = 1; m < steps.count; ++m) {
        const Eigen::Matrix3Xd moves = eye_moves(machine, joints.row(steps.step[m]));
        for (std::size_t a = 0; a < steps.axes; ++a) {
            for (std::size_t k = 0; k < 3; ++k) {
                eye[(m * steps.groups + a / kAxisLanes) * 3 + k]
                   [static_cast<Eigen::Index>(a % kAxisLanes)] =
                       moves(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(a)) *
                       machine.axis(a).acceleration / 8.0;
            }
        }
    }
    return eye;
}

}  // namespace

MovingSteps moving_steps(const Machine& machine, const JointPath& joints,
                         std::span<const double> fibre_mm, const TimeLawOptions& options) {
    const double fibre_mm_s = std::min(options.fibre_speed_mm_s, machine.fibre.max_speed_mm_s);
    MovingSteps steps;
    steps.axes = joints.axis_count;
    steps.groups = (steps.axes + kAxisLanes - 1) / kAxisLanes;
    add_step(steps, 0, 1.0, kFibreLimit);
    for (std::size_t i = 1; i < joints.size(); ++i) {
        add_moving_step(steps, machine, joints, i, fibre_mm[i] / fibre_mm_s);
    }
    steps.count = steps.step.size() - 1;
    add_step(steps, 0, 1.0, kFibreLimit);
    steps.ramps = axis_ramps(machine, steps.axes, steps.groups);
    steps.corner.mm = options.corner_mm;
    steps.corner.linear_mm_s2 = linear_mm_s2(machine, steps.axes, steps.groups);
    if (!std::isinf(steps.corner.mm)) {
        steps.corner.eye_mm_s2 = eye_mm_s2(machine, joints, steps);
    }
    return steps;
}

double longest_ramp_s(const MovingSteps& steps, std::span<const double> duration_s, std::size_t m) {
    double longest = 0.0;
    for (std::size_t g = 0; g < steps.groups; ++g) {
        longest = std::max(longest, corner_ramps_s(steps, duration_s, m, g).maxCoeff());
    }
    return longest;
}

double room_ratio(const MovingSteps& steps, std::span<const double> duration_s, std::size_t m) {
    double worst_s = 0.0;
    for (std::size_t g = 0; g < steps.groups; ++g) {
        worst_s = std::max(worst_s, (corner_ramps_s(steps, duration_s, m - 1, g) +
                                     corner_ramps_s(steps, duration_s, m, g))
                                        .maxCoeff());
    }
    return 0.5 * worst_s / duration_s[m];
}

double corner_ratio(const MovingSteps& steps, std::span<const double> duration_s, std::size_t m) {
    if (m == 0 || m == steps.count || std::isinf(steps.corner.mm)) {
        return 0.0;
    }
    CornerOffset offset;
    for (std::size_t g = 0; g < steps.groups; ++g) {
        add_offset(steps, m, g, velocity_change_s(steps, duration_s, m, g),
                   corner_ramps_s(steps, duration_s, m, g), offset);
    }
    return std::sqrt(offset.mm2()) / steps.corner.mm;
}

}  // namespace meshwind
