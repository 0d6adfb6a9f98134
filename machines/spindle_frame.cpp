#include "machines/spindle_frame.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "machines/kinematics.h"

namespace meshwind {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Sine below which directions of a file, normalised when read, are parallel or at a right angle.
constexpr double kParallel = 1e-9;
// An axis that runs towards the spindle so closely does not say where it stands.
constexpr double kBeside_mm = 1e-3;

// From the spindle to the line of another axis, at a right angle to both where they are not
// parallel. \param along unit, the spindle's direction
Vector3d to_line(const Axis& spindle, const Vector3d& along, const Axis& other) {
    const Vector3d between = other.point_mm - spindle.point_mm;
    const Vector3d normal = along.cross(other.direction);
    return normal.norm() < kParallel
               ? Vector3d(between - along.dot(between) * along)
               : Vector3d(normal.dot(between) / normal.squaredNorm() * normal);
}

// Towards the head, at a right angle to the spindle; none where the file does not tell.
std::optional<Vector3d> to_head(const Machine& machine, const Vector3d& along) {
    const auto rotary = [](const Axis& axis) { return axis.type == AxisType::Rotary; };
    const std::vector<Axis>& chain = machine.eye_chain;
    constexpr int kMinArmAxes = 3;  // a head has two
    if (std::count_if(chain.begin(), chain.end(), rotary) >= kMinArmAxes) {
        const Axis& first = *std::find_if(chain.begin(), chain.end(), rotary);
        const Vector3d way_mm = to_line(machine.mandrel_chain.front(), along, first);
        return way_mm.norm() < kBeside_mm ? std::nullopt : std::optional(way_mm.normalized());
    }
    const Vector3d& exit = machine.eye.exit;
    return std::abs(exit.dot(along)) > kParallel ? std::nullopt : std::optional<Vector3d>(-exit);
}

void move(std::variant<Capsule, EnvelopeMesh>& shape, const Isometry3d& pose) {
    if (auto* const capsule = std::get_if<Capsule>(&shape)) {
        capsule->from_mm = pose * capsule->from_mm;
        capsule->to_mm = pose * capsule->to_mm;
        return;
    }
    for (Vector3d& point_mm : std::get<EnvelopeMesh>(shape).triangles.points_mm) {
        point_mm = pose * point_mm;
    }
}

void move(std::vector<Axis>& chain, const Isometry3d& pose) {
    for (Axis& axis : chain) {
        axis.direction = pose.linear() * axis.direction;
        axis.point_mm = pose * axis.point_mm;
    }
}

}  // namespace

Machine in_spindle_frame(Machine machine) {
    if (machine.mandrel_chain.size() != 1 ||
        machine.mandrel_chain.front().type != AxisType::Rotary || spindle_sign(machine)) {
        return machine;
    }
    const Axis& spindle = machine.mandrel_chain.front();
    const Vector3d z = machine.mount ? machine.mount->z : spindle.direction;
    const std::optional<Vector3d> x = to_head(machine, z);
    if (z.cross(spindle.direction).norm() > kParallel || !x) {
        return machine;
    }
    Isometry3d file_from_spindle = Isometry3d::Identity();
    file_from_spindle.linear() << *x, z.cross(*x), z;
    file_from_spindle.translation() = spindle.point_mm - z.dot(spindle.point_mm) * z;
    const Isometry3d pose = file_from_spindle.inverse();
    if (spindle.direction.cross(Vector3d::UnitZ()).norm() > kParallel) {
        machine.up = pose.linear() * Vector3d::UnitZ();
    }

    move(machine.mandrel_chain, pose);
    move(machine.eye_chain, pose);
    EyeHead& eye = machine.eye;
    eye.position_mm = pose * eye.position_mm;
    eye.roller = pose.linear() * eye.roller;
    eye.exit = pose.linear() * eye.exit;
    for (EnvelopePart& part : eye.envelope) {
        move(part.shape, pose);
    }
    for (MachineBody& body : machine.bodies) {
        move(body.shape, pose);
    }
    if (std::optional<MandrelMount>& mount = machine.mount) {
        mount->origin_mm = pose * mount->origin_mm;
        mount->x = pose.linear() * mount->x;
        mount->z = pose.linear() * mount->z;
    }
    return machine;
}

}  // namespace meshwind
