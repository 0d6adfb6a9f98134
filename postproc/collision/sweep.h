/// Sweeps of machine parts over one step of a motion. Included by .cpp files of this folder only.
#pragma once

#include <span>
#include <vector>

#include "machines/machine.h"
#include "mesh/ray_query.h"
#include "postproc/collision/chunk.h"
#include "postproc/collision/collision.h"
#include "postproc/eye/eye_path.h"

namespace meshwind {

/// Largest distance beyond the limit that a sweep may still take for a hit.
inline constexpr double kSweepSlack_mm = 2.0 * kSweepResolution_mm;

/// A piece of a machine part, and the link that carries it.
struct LinkedChunk {
    char link = '?';
    Chunk chunk;
};

[[nodiscard]] std::vector<LinkedChunk> chunks_of(const std::vector<HeadEnvelope::Part>& parts);

/// Pose of a link of either chain, or of the base.
[[nodiscard]] Eigen::Isometry3d base_from_part(const Machine& machine, std::span<const double> q,
                                               char link);

/// The joints go straight from one position to the other.
struct MachineStep {
    const Machine& machine;
    std::span<const double> from;
    std::span<const double> to;
};

/// Obstacles that turn with the mandrel, and the distance that a piece has to keep.
struct SweptObstacles {
    const RayQuery& obstacles;
    double need_mm = 0.0;
};

/// Whether a piece stays clear of the mandrel over a step.
[[nodiscard]] bool is_clear(const MachineStep& step, const SweptObstacles& mandrel,
                            const LinkedChunk& part);

/// Upper bound on the motion of a piece against the mandrel over a step.
[[nodiscard]] double most_motion_mm(const MachineStep& step, const LinkedChunk& part);

/// Whether the head's piece stays clear of a body that stands on the machine over a step.
[[nodiscard]] bool is_clear_of_body(const MachineStep& step, const LinkedChunk& body,
                                    const LinkedChunk& part, double need_mm);

/// The same for the straight fibre from the landing point, which the mandrel carries, to the eye.
[[nodiscard]] bool is_fibre_clear_of_body(const MachineStep& step, const LinkedChunk& body,
                                          const EyePoint& a, const EyePoint& b);

}  // namespace meshwind
