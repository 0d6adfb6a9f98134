/// What the axes of a robot do while it carries a frame along the moves of a program.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/units.h"
#include "machines/machine.h"
#include "machines/pose_inverse.h"
#include "postproc/motion/joint_path.h"
#include "postproc/motion/time_law.h"
#include "postproc/ringhead/frame_axis.h"

namespace meshwind {

/// A place on the way: the moves are cut into equal pieces, so short that axes run evenly in each.
struct CarriedSample {
    std::size_t move = 0;  ///< 0: the start; else move i leads from point i - 1 to point i
    double share = 1.0;    ///< of the move, > 0
    double s_mm = 0.0;     ///< of the frame's axis at the head
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of the mandrel frame
};

inline constexpr double kSampleWay_mm = 5.0;
inline constexpr double kSampleTurn_rad = 0.5 * kPi / 180.0;

/// The start and the pieces of all moves. \pre one place and one pose for each point
[[nodiscard]] std::vector<CarriedSample> sample_moves(const std::vector<double>& s_mm,
                                                      const std::vector<Eigen::Isometry3d>& poses);

/// Axis values along the samples.
struct CarriedJoints {
    JointPath path;               ///< a row for each sample; its violations are those of travel
    double residual_mm = 0.0;     ///< largest distance from a pose that cannot be reached
    double residual_rad = 0.0;    ///< and angle
    std::size_t residual_at = 0;  ///< sample
    std::size_t flips = 0;        ///< steps in which an axis turns by more than a quarter turn
    std::size_t first_flip = 0;   ///< sample, where there is one
    double singular = 1.0;        ///< least PoseState::singular
    Singularity nearest = Singularity::Other;  ///< there
    std::size_t singular_at = 0;

    [[nodiscard]] bool reached() const {
        return residual_mm <= kPoseReached_mm && residual_rad <= kPoseReached_rad;
    }
    [[nodiscard]] bool holds() const { return reached() && flips == 0 && path.violations.empty(); }
};

/// Follows the samples from each way in which the robot can take the start: shoulder, elbow and
/// wrist either way for an arm. The result is the first that can be followed to the end within all
/// travels and without a flip, in the order of their largest step from all axes at zero; where none
/// can, the one that lacks least (reach, then flips, then travel).
/// \param tool pose of the mandrel frame in the frame that the machine file gives as its mandrel's
[[nodiscard]] CarriedJoints follow_samples(const Machine& machine,
                                           const std::vector<CarriedSample>& samples,
                                           const Eigen::Isometry3d& tool);

/// Duration of each move, the first 0: the frame passes at `speed_mm_s` where the axes' velocities
/// and accelerations (time_law.h, from move to move) let it. Within a move all runs evenly.
/// \pre 0 < speed_mm_s <= machine.fibre.max_speed_mm_s
[[nodiscard]] TimedPath time_moves(const Machine& machine,
                                   const std::vector<CarriedSample>& samples,
                                   const CarriedJoints& joints, double speed_mm_s);

/// What given durations of the moves ask of the axes: velocities in each sample's piece,
/// accelerations from move to move.
[[nodiscard]] AxisLoads move_loads(const Machine& machine,
                                   const std::vector<CarriedSample>& samples,
                                   const CarriedJoints& joints,
                                   const std::vector<double>& duration_s);

/// How near the frame, a tube about its axis, comes to what stands on the machine's base.
struct FrameClearance {
    double least_mm = 0.0;   ///< surface to surface; negative where they meet
    std::size_t sample = 0;  ///< where
    std::size_t body = 0;    ///< of the machine file
};

/// Of the capsules among the machine's bodies whose link is the base; nothing where there is none.
/// At each sample the exact distances of the chords between stations; what the frame can move
/// between two samples and what its axis can leave the chords is taken off, so that nothing slips
/// through.
[[nodiscard]] std::optional<FrameClearance> frame_clearance(
    const Machine& machine, const FrameAxis& axis, const std::vector<CarriedSample>& samples,
    double tube_radius_mm);

}  // namespace meshwind
