/// Stations at which a motion collides, and the repair of a motion of least time there; of a long
/// fibre by a few of its circuits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "machines/machine.h"
#include "mesh/ray_query.h"
#include "postproc/collision/collision.h"
#include "postproc/eye/eye_path.h"
#include "postproc/eye/eye_rules.h"
#include "postproc/eye/repeated_path.h"
#include "postproc/motion/choose_blocks.h"
#include "postproc/motion/joint_path.h"
#include "postproc/motion/mend_motion.h"

namespace meshwind {

/// The axes along the fibre.
struct AxisPath {
    EyePath path;      ///< with points between stations where the axes need them
    JointPath joints;  ///< along that path
};

/// A machine, its obstacles, and the fineness of the check on its motion.
struct MotionCheck {
    const Machine& machine;
    const HeadEnvelope& envelope;
    const RayQuery& obstacles;
    CollisionRule rule;
    BlockTolerance tolerance;
};

/// The first station that is not before a point of a piece; the last one where all are.
/// \pre there are stations
[[nodiscard]] std::size_t station_of(std::int32_t piece, std::int32_t point,
                                     const EyePath& stations);

/// Stations at which a motion hits something or passes a limit, in no order.
/// \param report of that motion
[[nodiscard]] std::vector<std::size_t> hit_stations(const AxisPath& axes,
                                                    const CollisionReport& report,
                                                    const EyePath& stations);

/// A motion under improvement.
struct Improvement {
    MotionImprover improver;
    std::optional<RepeatedPath> repeated;  ///< the improver has its few points; none: it has all
};

/// Begins with the eyes and the central angle. Where there are many stations and circuits repeat,
/// it has only those of a few circuits.
[[nodiscard]] Improvement improvement_of(const MotionCheck& check, double fibre_speed_mm_s,
                                         EyeRule rule, const EyePathResult& eyes);

/// The improver's motion for all stations. \param stations of the improvement
[[nodiscard]] EyePath improved(const Improvement& improvement, EyePath stations);

/// Stations of the improver's path, for those of the whole one.
[[nodiscard]] std::vector<std::size_t> of_improver(const Improvement& improvement,
                                                   std::vector<std::size_t> stations);

/// Stations of the improver's path, in the stretches changed last, at which its motion is not
/// clear.
[[nodiscard]] std::vector<std::size_t> hits_of_change(const MotionCheck& check,
                                                      const MotionImprover& improver);

}  // namespace meshwind
