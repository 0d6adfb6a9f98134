#include "machines/kinematics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/units.h"

namespace meshwind {
namespace {

// Directions in machine files are unit vectors of about six digits, normalised when read; axes that
// are meant to be parallel to X, Y or Z are exactly so.
constexpr double kParallel = 1e-9;
// Determinant of the three linear directions below which they do not span space in practice.
constexpr double kMinVolume = 1e-3;
constexpr double kPointTolerance_mm = 1e-9;

Eigen::Isometry3d pose_of(const MandrelMount& mount) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() << mount.x, mount.z.cross(mount.x), mount.z;
    pose.translation() = mount.origin_mm;
    return pose;
}

// Multiplies `pose` by the exponential of one axis. A linear axis leaves the directions as they
// are.
void append(Eigen::Isometry3d& pose, const Axis& axis, double value) {
    if (axis.type == AxisType::Linear) {
        const Eigen::Vector3d way_mm = value * axis.direction;
        pose.translate(way_mm);
        return;
    }
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(value, axis.direction).toRotationMatrix();
    const Eigen::Vector3d shift_mm = axis.point_mm - turn * axis.point_mm;
    pose.translate(shift_mm).rotate(turn);
}

Eigen::Isometry3d product_of_exponentials(const std::vector<Axis>& chain,
                                          std::span<const double> q) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (std::size_t i = 0; i < chain.size(); ++i) {
        append(pose, chain[i], q[i]);
    }
    return pose;
}

// +1 or -1 when the axis runs along +-`line`, else 0.
double sign_along(const Eigen::Vector3d& direction, const Eigen::Vector3d& line) {
    if (direction.cross(line).norm() > kParallel) {
        return 0.0;
    }
    return direction.dot(line) > 0.0 ? 1.0 : -1.0;
}

double distance_to_axis(const Axis& axis, const Eigen::Vector3d& point_mm) {
    return axis.direction.cross(point_mm - axis.point_mm).norm();
}

[[noreturn]] void unsupported(const Machine& machine, const std::string& words) {
    throw InputError(
        "machine.unsupported_chain", machine.name,
        words +
            "; the closed form needs one spindle, the exit at a right angle to it, one "
            "to three linear axes and at most a head roll along the exit and a head "
            "swing across both, the two through the eye");
}

[[noreturn]] void missing(const Machine& machine, const std::string& words) {
    throw InputError("machine.missing_axis", machine.name, words);
}

std::string name_of(const Axis& axis) {
    return std::string("axis ") + axis.letter;
}

// The value among `value + k * period` nearest to `reference`.
double nearest_turn(double value, double reference, double period) {
    return value + period * std::round((reference - value) / period);
}

}  // namespace

Eigen::Isometry3d base_from_mandrel(const Machine& machine, std::span<const double> q) {
    assert(q.size() == machine.axis_count());
    const Eigen::Isometry3d pose = product_of_exponentials(machine.mandrel_chain, q);
    return machine.mount ? pose * pose_of(*machine.mount) : pose;
}

Eigen::Isometry3d base_from_link(const Machine& machine, std::span<const double> q, char link) {
    assert(q.size() == machine.axis_count());
    const std::optional<std::size_t> last = machine.joint_of(link);
    assert(last && "link is in neither chain");
    const std::size_t eye = machine.mandrel_chain.size();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (std::size_t joint = *last < eye ? 0 : eye; joint <= *last; ++joint) {
        append(pose, machine.axis(joint), q[joint]);
    }
    return pose;
}

Eigen::Isometry3d base_from_eye(const Machine& machine, std::span<const double> q) {
    assert(q.size() == machine.axis_count());
    return product_of_exponentials(machine.eye_chain, q.subspan(machine.mandrel_chain.size())) *
           Eigen::Translation3d(machine.eye.position_mm);
}

std::vector<PlacedAxis> placed_axes(const Machine& machine, std::span<const double> q) {
    assert(q.size() == machine.axis_count());
    std::vector<PlacedAxis> placed;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (std::size_t joint = 0; joint < machine.axis_count(); ++joint) {
        if (joint == machine.mandrel_chain.size()) {
            pose.setIdentity();
        }
        const Axis& axis = machine.axis(joint);
        placed.push_back({axis.type, pose.linear() * axis.direction, pose * axis.point_mm});
        append(pose, axis, q[joint]);
    }
    return placed;
}

Eigen::Isometry3d mandrel_from_eye(const Machine& machine, std::span<const double> q) {
    return base_from_mandrel(machine, q).inverse() * base_from_eye(machine, q);
}

Eigen::Matrix3Xd eye_moves(const Machine& machine, std::span<const double> q) {
    const Eigen::Vector3d eye_mm = base_from_eye(machine, q).translation();
    Eigen::Matrix3Xd moves(3, static_cast<Eigen::Index>(machine.axis_count()));
    Eigen::Index joint = 0;
    const auto add = [&](const std::vector<Axis>& chain, double sign) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        for (const Axis& axis : chain) {
            const Eigen::Vector3d direction = pose.linear() * axis.direction;
            const Eigen::Vector3d arm_mm = eye_mm - pose * axis.point_mm;
            moves.col(joint) =
                sign * (axis.type == AxisType::Linear ? direction : direction.cross(arm_mm));
            append(pose, axis, q[static_cast<std::size_t>(joint)]);
            ++joint;
        }
    };
    add(machine.mandrel_chain, -1.0);
    add(machine.eye_chain, 1.0);
    return moves;
}

std::optional<double> spindle_sign(const Machine& machine) {
    if (machine.mandrel_chain.size() != 1 ||
        machine.mandrel_chain.front().type != AxisType::Rotary) {
        return std::nullopt;
    }
    const Axis& axis = machine.mandrel_chain.front();
    const double sign = sign_along(axis.direction, Eigen::Vector3d::UnitZ());
    const bool through_origin =
        distance_to_axis(axis, Eigen::Vector3d::Zero()) <= kPointTolerance_mm;
    return sign != 0.0 && through_origin ? std::optional(sign) : std::nullopt;
}

bool is_mounted_along_z(const Machine& machine) {
    const std::optional<MandrelMount>& mount = machine.mount;
    return !mount || (mount->origin_mm.head<2>().norm() <= kPointTolerance_mm &&
                      (mount->x - Eigen::Vector3d::UnitX()).norm() <= kParallel &&
                      (mount->z - Eigen::Vector3d::UnitZ()).norm() <= kParallel);
}

SpindleWristInverse::SpindleWristInverse(const Machine& machine)
    : eye_zero_mm_(machine.eye.position_mm) {
    recognise_spindle(machine);
    recognise_mount(machine);
    recognise_linear(machine);
    recognise_wrist(machine);
    if (sign_along(machine.eye.roller, Eigen::Vector3d::UnitZ()) == 0.0) {
        unsupported(machine, "the roller is not along the spindle at zero");
    }
    if (sign_along(machine.eye.exit, Eigen::Vector3d::UnitX()) != -1.0) {
        unsupported(machine, "the exit is not along -X of the spindle's frame at zero");
    }
}

void SpindleWristInverse::recognise_spindle(const Machine& machine) {
    if (machine.mandrel_chain.empty()) {
        missing(machine, "the mandrel chain has no axis; add the spindle");
    }
    const Axis& spindle = machine.mandrel_chain.front();
    if (machine.mandrel_chain.size() != 1 || spindle.type != AxisType::Rotary) {
        unsupported(machine, "the mandrel chain is not one rotary axis");
    }
    spindle_sign_ = spindle_sign(machine).value_or(0.0);
    if (spindle_sign_ == 0.0) {
        unsupported(machine, name_of(spindle) +
                                 " is not at a right angle to the exit, or not along z of the "
                                 "mandrel frame");
    }
}

void SpindleWristInverse::recognise_mount(const Machine& machine) {
    if (!is_mounted_along_z(machine)) {
        unsupported(machine,
                    "the mandrel frame at zero is not that of the spindle, moved along it: z along "
                    "the spindle, x against the exit");
    }
    if (machine.mount) {  // what is left to move when the eye is at the target
        eye_zero_mm_.z() -= machine.mount->origin_mm.z();
    }
}

void SpindleWristInverse::recognise_linear(const Machine& machine) {
    std::size_t& count = linear_count_;
    while (count < machine.eye_chain.size() && machine.eye_chain[count].type == AxisType::Linear) {
        ++count;
    }
    if (count == 0) {
        missing(machine,
                "the eye chain does not start with a linear axis; add the carriage, or all six "
                "rotary axes of a robot that holds the eye, the last three through one point");
    }
    if (count > 3) {
        unsupported(machine, "the eye chain has more than three linear axes");
    }
    for (std::size_t i = 0; i < count; ++i) {
        linear_[i] = machine.mandrel_chain.size() + i;
        linear_axis_[i] = machine.eye_chain[i];
        machine_from_linear_.col(static_cast<Eigen::Index>(i)) = machine.eye_chain[i].direction;
    }
    if (count == 3) {
        if (std::abs(machine_from_linear_.determinant()) < kMinVolume) {
            unsupported(machine, "the three linear axes lie in one plane");
        }
        linear_from_machine_ = machine_from_linear_.inverse();
        return;
    }
    if (count == 2 &&
        machine_from_linear_.col(0).cross(machine_from_linear_.col(1)).norm() < kMinVolume) {
        unsupported(machine, "the two linear axes are parallel");
    }
    Eigen::Matrix3d products = machine_from_linear_.transpose() * machine_from_linear_;
    for (auto i = static_cast<Eigen::Index>(count); i < 3; ++i) {
        products(i, i) = 1.0;  // an axis that is not there stays at zero
    }
    linear_from_machine_ = products.inverse() * machine_from_linear_.transpose();
}

bool SpindleWristInverse::reaches_all() const {
    if (linear_count_ != 2) {
        return linear_count_ == 3;
    }
    const Eigen::Vector3d normal =
        machine_from_linear_.col(0).cross(machine_from_linear_.col(1)).normalized();
    return sign_along(normal, Eigen::Vector3d::UnitY()) != 0.0 &&
           std::abs(eye_zero_mm_.y()) < kPointTolerance_mm;
}

void SpindleWristInverse::recognise_wrist(const Machine& machine) {
    const auto rotary = [&](std::size_t link, const Eigen::Vector3d& line, const char* words) {
        const Axis& axis = machine.eye_chain[link];
        RotaryJoint joint{.joint = machine.mandrel_chain.size() + link,
                          .sign = sign_along(axis.direction, line),
                          .min = axis.min,
                          .max = axis.max};
        if (axis.type != AxisType::Rotary || joint.sign == 0.0) {
            unsupported(machine, name_of(axis) + " is not a rotary axis along " + words);
        }
        if (distance_to_axis(axis, machine.eye.position_mm) > kPointTolerance_mm) {
            unsupported(machine, name_of(axis) + " does not pass through the eye");
        }
        return joint;
    };
    const std::size_t links = machine.eye_chain.size() - linear_count_;
    has_roll_ = links > 0;
    has_swing_ = links > 1;
    if (has_roll_) {
        roll_ = rotary(linear_count_, Eigen::Vector3d::UnitX(), "the exit (head roll)");
    }
    if (has_swing_) {
        swing_ = rotary(linear_count_ + 1, Eigen::Vector3d::UnitY(),
                        "a right angle to exit and spindle (head swing)");
    }
    if (links > 2) {
        unsupported(machine, "the eye chain has more than two rotary axes");
    }
}

struct SpindleWristInverse::Choice {
    double previous_roll = 0.0;
    double previous_swing = 0.0;
    bool within_limits = false;
    double step_rad = std::numeric_limits<double>::infinity();
    double roll = 0.0;
    double swing = 0.0;
};

void SpindleWristInverse::consider(double roll_rad, double swing_rad, Choice& best) const {
    const double swing = nearest_turn(swing_.sign * swing_rad, best.previous_swing, 2.0 * kPi);
    const double nearest = nearest_turn(roll_.sign * roll_rad, best.previous_roll, 2.0 * kPi);
    const bool swing_ok = !has_swing_ || (swing >= swing_.min && swing <= swing_.max);
    // An end stop of the roll may forbid the nearest turn and allow a neighbour.
    for (const double turns : {0.0, -1.0, 1.0}) {
        const double roll = nearest + turns * 2.0 * kPi;
        const bool within = swing_ok && roll >= roll_.min && roll <= roll_.max;
        const double step =
            std::max(std::abs(roll - best.previous_roll), std::abs(swing - best.previous_swing));
        if (within == best.within_limits ? step < best.step_rad : within) {
            best.within_limits = within;
            best.step_rad = step;
            best.roll = roll;
            best.swing = swing;
        }
    }
}

// Roll and swing for the fibre and its binormal, both in the machine frame.
void SpindleWristInverse::turn_head(const Eigen::Vector3d& tau, const Eigen::Vector3d& binormal,
                                    Choice& best, WristState& state) const {
    const Eigen::Vector3d wanted =
        has_swing_ ? binormal : Eigen::Vector3d(Eigen::Vector3d::UnitX().cross(tau));
    state.singular_sine = std::hypot(wanted.y(), wanted.z());
    state.held = state.singular_sine < kSingularSine;
    const double held_roll = roll_.sign * best.previous_roll;
    const double roll = state.held ? held_roll : std::atan2(-wanted.y(), wanted.z());
    if (has_swing_) {
        // atan2 keeps full accuracy where asin loses half the digits, near +-90 degrees.
        const double swing = std::atan2(wanted.x(), state.singular_sine);
        const double other_roll = state.held ? held_roll : roll + kPi;
        consider(roll, swing, best);
        consider(other_roll, kPi - swing, best);
        consider(other_roll, -swing, best);
        consider(roll, swing + kPi, best);
    } else {
        consider(roll, 0.0, best);
        consider(state.held ? roll : roll + kPi, 0.0, best);
        const double a = roll_.sign * best.roll;
        const Eigen::Vector3d roller(0.0, -std::sin(a), std::cos(a));
        state.twist_rad = std::atan2(roller.cross(binormal).norm(), std::abs(roller.dot(binormal)));
    }
    state.flip_rad = std::abs(best.roll - best.previous_roll);
    state.flip = state.flip_rad > 0.5 * kPi;
}

WristState SpindleWristInverse::solve(const EyeTarget& target, double turn_rad,
                                      std::span<const double> previous,
                                      std::span<double> joints) const {
    const Eigen::Matrix3d machine_from_mandrel =
        Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    Choice best{.previous_roll = has_roll_ ? previous[roll_.joint] : 0.0,
                .previous_swing = has_swing_ ? previous[swing_.joint] : 0.0};
    const Eigen::Vector3d binormal = machine_from_mandrel * target.binormal;
    WristState state;
    if (has_roll_) {
        turn_head(machine_from_mandrel * target.tangent, binormal, best, state);
    } else {
        const Eigen::Vector3d roller = Eigen::Vector3d::UnitZ();
        state.twist_rad = std::atan2(roller.cross(binormal).norm(), std::abs(roller.dot(binormal)));
    }
    const Eigen::Vector3d way = machine_from_mandrel * target.eye_mm - eye_zero_mm_;
    const Eigen::Vector3d linear = linear_from_machine_ * way;
    joints[0] = spindle_sign_ * turn_rad;
    for (std::size_t i = 0; i < linear_count_; ++i) {
        joints[linear_[i]] = linear[static_cast<Eigen::Index>(i)];
    }
    if (linear_count_ < 3) {
        state.residual_mm = (way - machine_from_linear_ * linear).norm();
    }
    if (has_roll_) {
        joints[roll_.joint] = best.roll;
    }
    if (has_swing_) {
        joints[swing_.joint] = best.swing;
    }
    return state;
}

bool SpindleWristInverse::within_travel(const Eigen::Vector3d& linear) const {
    for (std::size_t i = 0; i < linear_count_; ++i) {
        const double value = linear[static_cast<Eigen::Index>(i)];
        if (value < linear_axis_[i].min || value > linear_axis_[i].max) {
            return false;
        }
    }
    return true;
}

std::optional<double> SpindleWristInverse::forced_turn(const EyeTarget& target,
                                                       double near_rad) const {
    const Eigen::Vector3d& eye = target.eye_mm;
    const double radius = eye.head<2>().norm();
    if (linear_count_ == 3 || radius < kPointTolerance_mm) {
        return std::nullopt;
    }
    // The axes leave the direction `normal` of the machine frame out: its component of the turned
    // eye, a cos t + b sin t, must be c.
    Eigen::Vector3d normal = machine_from_linear_.col(0).cross(machine_from_linear_.col(1));
    const Eigen::Vector3d zero_out(eye_zero_mm_.x(), eye_zero_mm_.y(), 0.0);
    std::array<double, 2> turns{};
    if (linear_count_ == 1) {
        if (sign_along(machine_from_linear_.col(0), Eigen::Vector3d::UnitZ()) == 0.0 ||
            zero_out.norm() < kPointTolerance_mm) {
            return std::nullopt;
        }
        turns.fill(std::atan2(zero_out.y(), zero_out.x()) - std::atan2(eye.y(), eye.x()));
    } else {
        normal.normalize();
        const double a = normal.x() * eye.x() + normal.y() * eye.y();
        const double b = normal.y() * eye.x() - normal.x() * eye.y();
        const double c = normal.dot(eye_zero_mm_) - normal.z() * eye.z();
        const double most = std::hypot(a, b);
        if (normal.head<2>().norm() < kParallel) {
            return std::nullopt;
        }
        const double half = std::acos(std::clamp(c / most, -1.0, 1.0));
        turns = {std::atan2(b, a) + half, std::atan2(b, a) - half};
    }
    std::optional<double> best;
    bool best_inside = false;
    for (const double turn : turns) {
        const double nearest = nearest_turn(turn, near_rad, 2.0 * kPi);
        const Eigen::Vector3d turned =
            Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix() * eye;
        const bool inside = within_travel(linear_from_machine_ * (turned - eye_zero_mm_));
        if (!best ||
            (inside == best_inside ? std::abs(nearest - near_rad) < std::abs(*best - near_rad)
                                   : inside)) {
            best = nearest;
            best_inside = inside;
        }
    }
    return best;
}

}  // namespace meshwind
