/// Joint path of a robot that carries a frame along the moves of a program: axes, time, clearance.
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

/// A sample of the moves, which are cut into equal pieces, so short that axes run evenly in each.
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

/// Follows the samples from each solution for the start: shoulder, elbow and wrist either way for
/// an arm. The result is the first path that reaches the end within all travels and without a flip,
/// in the order of the solutions' largest step from all axes at zero; if there is none, the one
/// that fails least (reach, then flips, then travel).
/// \param tool pose of the mandrel frame in the frame that the machine file gives as its mandrel's
[[nodiscard]] CarriedJoints follow_samples(const Machine& machine,
                                           const std::vector<CarriedSample>& samples,
                                           const Eigen::Isometry3d& tool);

/// Duration of each move, the first 0: the frame passes at `speed_mm_s` where the axes' velocities
/// and accelerations (time_law.h, from move to move) let it. Within a move all axes run evenly.
/// \pre 0 < speed_mm_s <= machine.fibre.max_speed_mm_s
[[nodiscard]] TimedPath time_moves(const Machine& machine,
                                   const std::vector<CarriedSample>& samples,
                                   const CarriedJoints& joints, double speed_mm_s);

/// Loads of the axes for given durations of the moves: velocities in each sample's piece,
/// accelerations from move to move.
[[nodiscard]] AxisLoads move_loads(const Machine& machine,
                                   const std::vector<CarriedSample>& samples,
                                   const CarriedJoints& joints,
                                   const std::vector<double>& duration_s);

/// Least clearance of the frame, a tube about its axis, from bodies on the machine's base.
struct FrameClearance {
    double least_mm = 0.0;   ///< surface to surface; negative where they meet
    std::size_t sample = 0;  ///< where
    std::size_t body = 0;    ///< of the machine file
};

/// Clearance from the capsules among the machine's bodies whose link is the base; nothing where
/// there is none. Takes at each sample the exact distances of the chords between stations, less the
/// frame's possible motion between two samples and its axis' distance from the chords, so that
/// nothing slips through.
[[nodiscard]] std::optional<FrameClearance> frame_clearance(
    const Machine& machine, const FrameAxis& axis, const std::vector<CarriedSample>& samples,
    double tube_radius_mm);

}  // namespace meshwind
