/// Deviation of the fibre from the plan over one block of a dense path. For choose_blocks.h alone.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "machines/machine.h"
#include "postproc/eye/fibre_curve.h"
#include "postproc/motion/choose_blocks.h"

namespace meshwind {

/// Rounding of joint values and frames: free lengths planned at a limit count as within it.
inline constexpr double kFreeLengthRounding_mm = 1e-6;

/// A block, or the part of it up to where it left the tolerance.
struct BlockDeviation {
    double offset_mm = 0.0;  ///< y, signed, at the end
    double tilt_rad = 0.0;   ///< dy/ds, signed, where the fibre was laid last
    double turn_per_mm = 0.0;
    double turn_share = 0.0;  ///< of the room it has
    double sideways_mm = 0.0;
    double angle_rad = 0.0;
    double pull_mm = 0.0;
    double eye_mm = 0.0;
    double eye_share = 0.0;  ///< of the room it has
    double twist_rad = 0.0;
    double share = 1.0;      ///< of the tolerance, the least on the way
    double length_mm = 0.0;  ///< free length beyond the machine's limits
    double fibre_mm = 0.0;
};

/// A place on the dense path; the last point has no share.
struct DensePlace {
    std::size_t step = 0;  ///< between points `step` and `step + 1`
    double share = 0.0;
};

/// Where the fibre touches down.
struct DenseLanding {
    DensePlace place;
    FibreFrame at;
};

/// Measures blocks of a task.
class BlockCheck {
public:
    /// \param machine, task, tolerance must outlive this
    BlockCheck(const Machine& machine, const BlockTask& task, const BlockTolerance& tolerance);

    /// The block from point to point when the fibre arrives `offset_mm` beside the plan; only up to
    /// where it leaves the tolerance when `stop` is set.
    [[nodiscard]] BlockDeviation measure(std::size_t first, std::size_t last, double offset_mm,
                                         bool stop) const;

    /// Whether a block keeps the tolerance. Fibre that arrives beyond it may not get further off.
    [[nodiscard]] bool within(const BlockDeviation& block, double offset_mm) const;

    /// Number of parts into which a single step must be cut.
    [[nodiscard]] int parts(std::size_t step) const;

private:
    [[nodiscard]] double height(std::size_t point, const Eigen::Vector3d& eye_mm) const;
    void advance(const Eigen::Vector3d& eye_mm, std::size_t last, DenseLanding& landing) const;
    void lay(const Eigen::Vector3d& eye_mm, std::size_t last, DenseLanding& landing,
             BlockDeviation& worst) const;
    void compare(const Eigen::Isometry3d& pose, std::size_t last, const DensePlace& nearest,
                 BlockDeviation& worst) const;

    const Machine& machine_;
    const BlockTask& task_;
    const EyePath& path_;
    const BlockTolerance& tolerance_;
    std::vector<double> twist_rad_;        // of the roller against the binormal, per point
    std::vector<Eigen::Vector3d> normal_;  // per point
};

}  // namespace meshwind
