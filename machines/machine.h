/// A winding machine: two chains of axes, the delivery eye, the fibre path and the controller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "mesh/triangle_soup.h"

namespace meshwind {

enum class AxisType { Linear, Rotary };

/// One axis. Its unit is mm when linear and rad when rotary ("axis units"); infinite ends mean that
/// there is no limit. Direction and point are in the machine frame with all axes at zero.
struct Axis {
    char letter = '?';  ///< A to Z, unique in the machine
    AxisType type = AxisType::Linear;
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit; motion or right-hand axis
    Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();  ///< on the axis; of no effect when linear
    double min = 0.0;                                    ///< axis units, < max
    double max = 0.0;                                    ///< axis units
    double velocity = 0.0;                               ///< axis units/s, > 0
    double acceleration = 0.0;                           ///< axis units/s^2, > 0
    double jerk = 0.0;  ///< axis units/s^3, > 0; infinite if not given
    /// Smallest increment in 1e-9 mm or 1e-9 **deg**, > 0: the unit of the code, so that rounding
    /// to it is exact integer arithmetic.
    std::int64_t resolution_nano = 0;
};

/// A ball-ended cylinder fixed to a link, machine frame at zero.
struct Capsule {
    Eigen::Vector3d from_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d to_mm = Eigen::Vector3d::Zero();
    double radius_mm = 0.0;  ///< > 0
};

/// A triangle mesh fixed to a link, machine frame at zero, in mm.
struct EnvelopeMesh {
    std::string file;  ///< path as it can be opened (relative names count from the machine file)
    TriangleSoup triangles{};  ///< of the file; empty until they are read (load_machine)
};

/// A piece of the machine that must not touch the mandrel.
struct EnvelopePart {
    char link = '?';  ///< letter of the axis of the eye chain that carries it
    std::variant<Capsule, EnvelopeMesh> shape;
};

/// The delivery eye, machine frame at zero.
struct EyeHead {
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  ///< where the fibre leaves the machine
    Eigen::Vector3d roller = Eigen::Vector3d::UnitZ();  ///< unit; the fibre leaves at a right angle
    Eigen::Vector3d exit = -Eigen::Vector3d::UnitX();   ///< unit, normal to the roller: the way out
    std::vector<EnvelopePart> envelope;
};

/// How the mandrel sits on the end of its chain: its frame in the machine frame at zero.
struct MandrelMount {
    Eigen::Vector3d origin_mm = Eigen::Vector3d::Zero();
    Eigen::Vector3d x = Eigen::Vector3d::UnitX();  ///< unit
    Eigen::Vector3d z = Eigen::Vector3d::UnitZ();  ///< unit, at a right angle to x
};

/// A part that does not belong to the eye's chain: a chuck, a shaft, a bed.
struct MachineBody {
    /// Letter of the axis of the mandrel's chain that carries it; nothing: it stands on the base.
    std::optional<char> link;
    std::variant<Capsule, EnvelopeMesh> shape;
};

/// Limits of the fibre path from the creel to the eye.
struct FibreLimits {
    double min_free_length_mm = 0.0;
    double max_free_length_mm = 0.0;
    double take_up_mm = 0.0;      ///< length the tensioner can take back
    double max_speed_mm_s = 0.0;  ///< of the fibre through the eye
};

enum class FeedMode { InverseTime, PerMinute };

struct Controller {
    std::string dialect;  ///< a name known to postproc/robot/dialects.h
    FeedMode feed = FeedMode::InverseTime;
    std::vector<std::string> header;  ///< lines put before the first move as they are
    std::vector<std::string> footer;  ///< lines put after the last move as they are
    std::optional<std::int32_t> program_number;
    std::optional<double> junction_deviation_mm;  ///< > 0, GRBL's $11; nothing: its default
    /// Letters of a robot's axes 1 to 6; empty: the last six of the eye's chain.
    std::string robot_axes;
    /// Letters of its external axes from the first on, `-` for a number that it does not have;
    /// empty: all others in the order of the joint vector.
    std::string external_axes;
};

/// A machine as read from its file (machines/machine_json.h); not changed afterwards.
/// Joint vectors hold the mandrel chain, then the eye chain, each from the base outward, axis
/// units.
struct Machine {
    std::string name;
    std::vector<Axis> mandrel_chain;
    std::vector<Axis> eye_chain;  ///< empty: the eye stands still
    /// Nothing: the mandrel frame at zero is the frame of the machine (machines/spindle_frame.h).
    std::optional<MandrelMount> mount;
    EyeHead eye;
    std::vector<MachineBody> bodies;
    FibreLimits fibre;
    Controller controller;
    /// Unit; upwards in a picture of a machine with one spindle (machines/spindle_frame.h).
    Eigen::Vector3d up = Eigen::Vector3d::UnitY();

    [[nodiscard]] std::size_t axis_count() const { return mandrel_chain.size() + eye_chain.size(); }

    /// Axis of entry `joint` of a joint vector. \pre joint < axis_count()
    [[nodiscard]] const Axis& axis(std::size_t joint) const {
        return joint < mandrel_chain.size() ? mandrel_chain[joint]
                                            : eye_chain[joint - mandrel_chain.size()];
    }

    /// Entry of the joint vector that belongs to a letter, or nothing.
    [[nodiscard]] std::optional<std::size_t> joint_of(char letter) const {
        for (std::size_t joint = 0; joint < axis_count(); ++joint) {
            if (axis(joint).letter == letter) {
                return joint;
            }
        }
        return std::nullopt;
    }
};

}  // namespace meshwind
