#include "machines/arm_inverse.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "machines/kinematics.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Directions of machine files are good to the last bit when they run along X, Y or Z.
constexpr double kParallel = 1e-9;
// Axes that pass each other within this are meant to meet.
constexpr double kMeet_mm = 1e-6;
// Sine, or share of the arm's length, below which the direction of what is left is rounding noise.
constexpr double kUndefined = 1e-10;

// Angle about the unit `axis` from `from` to `to`, of which only the parts across it count.
double angle_about(const Vector3d& axis, const Vector3d& from, const Vector3d& to) {
    const Vector3d u = from - axis.dot(from) * axis;
    const Vector3d v = to - axis.dot(to) * axis;
    return std::atan2(axis.dot(u.cross(v)), u.dot(v));
}

// The cosine's share of an argument that may lie beyond 1 where a pose is out of reach.
double clamped_acos(double cosine) {
    return std::acos(std::clamp(cosine, -1.0, 1.0));
}

Vector3d any_normal(const Vector3d& direction) {
    Vector3d other = Vector3d::Zero();
    Eigen::Index smallest = 0;
    direction.cwiseAbs().minCoeff(&smallest);
    other[smallest] = 1.0;
    return direction.cross(other).normalized();
}

}  // namespace

Isometry3d ArmInverse::Screw::motion(double angle_rad) const {
    Isometry3d motion = Isometry3d::Identity();
    motion.linear() = Eigen::AngleAxisd(angle_rad, direction).toRotationMatrix();
    motion.translation() = point_mm - motion.linear() * point_mm;
    return motion;
}

Vector3d ArmInverse::Screw::across(const Vector3d& point) const {
    const Vector3d from = point - point_mm;
    return from - direction.dot(from) * direction;
}

std::optional<ArmInverse> ArmInverse::recognise(const Machine& machine) {
    ArmInverse arm;
    if (machine.mandrel_chain.size() != arm.axis_.size()) {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < arm.axis_.size(); ++i) {
        const Axis& axis = machine.mandrel_chain[i];
        if (axis.type != AxisType::Rotary) {
            return std::nullopt;
        }
        arm.axis_[i] = {axis.direction, axis.point_mm};
    }
    const auto sine = [&](std::size_t i, std::size_t j) {
        return arm.axis_[i].direction.cross(arm.axis_[j].direction).norm();
    };
    if (sine(1, 2) > kParallel || sine(0, 1) < kParallel || sine(3, 4) < kParallel ||
        sine(4, 5) < kParallel) {
        return std::nullopt;
    }
    // The point of axis 4 that is nearest to axis 5.
    const Screw& roll = arm.axis_[3];
    const Screw& bend = arm.axis_[4];
    const Vector3d common = roll.direction.cross(bend.direction);
    const double along =
        (bend.point_mm - roll.point_mm).cross(bend.direction).dot(common) / common.squaredNorm();
    arm.wrist_mm_ = roll.point_mm + along * roll.direction;
    if (arm.axis_[4].across(arm.wrist_mm_).norm() > kMeet_mm ||
        arm.axis_[5].across(arm.wrist_mm_).norm() > kMeet_mm) {
        return std::nullopt;
    }
    // Upper arm and forearm of no length leave nothing to solve.
    if (arm.axis_[1].across(arm.axis_[2].point_mm).norm() < kMeet_mm ||
        arm.axis_[2].across(arm.wrist_mm_).norm() < kMeet_mm) {
        return std::nullopt;
    }
    const std::vector<double> zero(machine.axis_count(), 0.0);
    arm.mandrel_at_zero_ = base_from_mandrel(machine, zero);
    return arm;
}

// Axis 1 turned back, the wrist centre must have the component along axis 2 that it has at zero:
// a cos q + b sin q = c.
std::array<double, 2> ArmInverse::shoulder_angles(const Vector3d& wrist_mm, double previous) const {
    const Screw& first = axis_[0];
    const Vector3d& line = axis_[1].direction;
    const Vector3d out = first.across(wrist_mm);
    const Vector3d foot = wrist_mm - out;
    const double a = line.dot(out);
    const double b = -line.dot(first.direction.cross(out));
    const double c = line.dot(wrist_mm_ - foot);
    const double radius = std::hypot(a, b);
    if (radius < kUndefined * (1.0 + (wrist_mm_ - first.point_mm).norm())) {
        return {previous, previous};
    }
    const double middle = std::atan2(b, a);
    const double half = clamped_acos(c / radius);
    return {middle + half, middle - half};
}

// Axis 3, so that the wrist centre is `distance_mm` away from axis 2, measured across it.
std::array<double, 2> ArmInverse::elbow_angles(double distance_mm) const {
    const Screw& elbow = axis_[2];
    const Vector3d fore = elbow.across(wrist_mm_);
    const Vector3d upper = elbow.across(axis_[1].point_mm);  // from the elbow back to the shoulder
    const double zero = angle_about(elbow.direction, fore, upper);
    const double f = fore.norm();
    const double u = upper.norm();
    const double half = clamped_acos((f * f + u * u - distance_mm * distance_mm) / (2.0 * f * u));
    return {zero + half, zero - half};
}

// Axis 2, which brings the wrist centre to where it was reached when axis 1 is undone.
double ArmInverse::upper_arm_angle(double elbow_rad, const Vector3d& reached) const {
    const Vector3d bent = axis_[2].motion(elbow_rad) * wrist_mm_;
    return angle_about(axis_[1].direction, axis_[1].across(bent), axis_[1].across(reached));
}

// Axes 4, 5 and 6 for what is left of a motion when 1 to 3 are undone: a turn about the wrist
// centre. Either way.
std::array<ArmInverse::Joints, 2> ArmInverse::wrist_angles(const Isometry3d& motion, Joints joints,
                                                           std::span<const double> previous) const {
    const auto turn_of = [&](std::size_t i, double angle_rad) {
        return Eigen::AngleAxisd(angle_rad, axis_[i].direction).toRotationMatrix();
    };
    const Eigen::Matrix3d left_of_arm =
        (turn_of(0, joints[0]) * turn_of(1, joints[1]) * turn_of(2, joints[2])).transpose() *
        motion.linear();
    const Vector3d& d4 = axis_[3].direction;
    const Vector3d& d5 = axis_[4].direction;
    const Vector3d& d6 = axis_[5].direction;
    const Vector3d goal = left_of_arm * d6;  // where axis 6 points: exp(4) exp(5) d6
    const auto finished = [&](double q4, double q5) {
        joints[3] = q4;
        joints[4] = q5;
        const Eigen::Matrix3d left = turn_of(4, -q5) * turn_of(3, -q4) * left_of_arm;
        const Vector3d mark = any_normal(d6);
        joints[5] = angle_about(d6, mark, left * mark);
        return joints;
    };
    if (d4.cross(goal).norm() < kUndefined) {
        const double q4 = previous[3];
        const Joints only = finished(q4, angle_about(d5, d6, turn_of(3, -q4) * goal));
        return {only, only};
    }
    // Axis 4 turned back, axis 6 keeps its component along 4 and its length across, and has the
    // component along 5 that it has at zero. Lengths across, not cosines: near the singular pose
    // they keep their digits.
    const double along = d4.dot(goal);
    const double across = d4.cross(goal).norm();
    const Vector3d side5 = (d5 - d4.dot(d5) * d4).normalized();
    const double share = (d5.dot(d6) - d4.dot(d5) * along) / side5.dot(d5);
    const double rest = std::sqrt(std::max((across - share) * (across + share), 0.0));
    const auto to_a_side = [&](double side) {
        const Vector3d between = along * d4 + share * side5 + side * rest * d4.cross(side5);
        return finished(angle_about(d4, between, goal), angle_about(d5, d6, between));
    };
    const Joints one = to_a_side(1.0);
    return {one, to_a_side(-1.0)};
}

std::vector<ArmInverse::Joints> ArmInverse::solve(const Isometry3d& base_from_mandrel,
                                                  std::span<const double> previous) const {
    const Isometry3d motion = base_from_mandrel * mandrel_at_zero_.inverse();
    const Vector3d wrist = motion * wrist_mm_;
    std::vector<Joints> found;
    for (const double q1 : shoulder_angles(wrist, previous[0])) {
        const Vector3d reached = axis_[0].motion(-q1) * wrist;
        for (const double q3 : elbow_angles(axis_[1].across(reached).norm())) {
            const double q2 = upper_arm_angle(q3, reached);
            for (const Joints& way : wrist_angles(motion, {q1, q2, q3, 0.0, 0.0, 0.0}, previous)) {
                found.push_back(way);
            }
        }
    }
    return found;
}

ArmInverse::Joints ArmInverse::solve_near(const Isometry3d& base_from_mandrel,
                                          std::span<const double> previous) const {
    const auto away = [&](std::size_t i, double angle_rad) {
        return std::abs(std::remainder(angle_rad - previous[i], 2.0 * kPi));
    };
    const auto nearer = [&](std::size_t i, const std::array<double, 2>& angles_rad) {
        return away(i, angles_rad[1]) < away(i, angles_rad[0]) ? angles_rad[1] : angles_rad[0];
    };
    const auto wrist_away = [&](const Joints& way) {
        return std::max({away(3, way[3]), away(4, way[4]), away(5, way[5])});
    };
    const Isometry3d motion = base_from_mandrel * mandrel_at_zero_.inverse();
    const Vector3d wrist = motion * wrist_mm_;
    const double q1 = nearer(0, shoulder_angles(wrist, previous[0]));
    const Vector3d reached = axis_[0].motion(-q1) * wrist;
    const double q3 = nearer(2, elbow_angles(axis_[1].across(reached).norm()));
    const double q2 = upper_arm_angle(q3, reached);
    const auto ways = wrist_angles(motion, {q1, q2, q3, 0.0, 0.0, 0.0}, previous);
    return wrist_away(ways[1]) < wrist_away(ways[0]) ? ways[1] : ways[0];
}

ArmMeasure ArmInverse::measure(std::span<const double> joints) const {
    const Vector3d elbowed = axis_[1].motion(joints[1]) * axis_[2].motion(joints[2]) * wrist_mm_;
    const Vector3d fore = axis_[2].motion(joints[2]).linear() * axis_[2].across(wrist_mm_);
    const Vector3d upper = axis_[2].across(axis_[1].point_mm);
    const double length = fore.norm() + upper.norm();
    const Vector3d bent =
        Eigen::AngleAxisd(joints[4], axis_[4].direction).toRotationMatrix() * axis_[5].direction;
    ArmMeasure measure;
    measure.shoulder = std::min(axis_[0].across(elbowed).norm() / length, 1.0);
    measure.elbow = fore.cross(upper).norm() / (fore.norm() * upper.norm());
    measure.wrist = axis_[3].direction.cross(bent).norm();
    return measure;
}

}  // namespace meshwind
