/// Chooses the block ends among the points of a dense path: as few as keep the laid fibre on the
/// plan.
///
/// Between two block ends all joints move linearly and the eye runs along E(lambda). The fibre that
/// lies on the plan up to a landing point P with tangent t, normal n and binormal b = n x t stays
/// on it as long as the eye is on the ray from P along t, for a P that only advances: an eye that
/// is off along t has changed the free length, no more. The landing point under an eye is the one
/// with n . (E - P) = 0, and delta = b . (E - P) pulls the fibre sideways there. With the free
/// length L, fibre that is laid y beside the plan follows the eye by
///
///     dy/ds = (delta - y) / L,
///
/// so it forgets with the free length, |y| never exceeds max |delta|, and dy/ds is its angle to the
/// plan. Guarantee: y, integrated from the tie-on over all blocks, stays within `sideways_mm` and
/// dy/ds within `angle_rad`. Where the eye rises over the tangent plane it lifts fibre off and lays
/// it again; y is then taken as the worse of y and delta. Conditions: first order in delta and y,
/// both small against the free length and against the surface's radii of curvature. Rounding adds
/// to delta half a step of each axis, times the distance of the eye from the axis where it turns.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "machines/machine.h"
#include "postproc/eye/eye_path.h"
#include "postproc/motion/joint_path.h"

namespace meshwind {

/// Tolerances of a block between its ends.
struct BlockTolerance {
    double sideways_mm = 0.16;   ///< > 0; laid fibre off the plan
    double angle_rad = 0.0042;   ///< > 0; laid fibre against the plan
    double eye_mm = 2.0;         ///< > 0; eye off the curve of the planned eye
    double twist_rad = 0.01745;  ///< > 0; roller off the binormal, beyond that of the dense points
    /// > 0; most fibre of one block. Pieces longer than this are cut evenly where nothing else
    /// needs an end, so that none is left too short for its ramps.
    double most_mm = std::numeric_limits<double>::infinity();
};

/// A dense path with the bounds on the choice.
struct BlockTask {
    const EyePath& path;
    const JointPath& joints;            ///< of equal length
    std::span<const double> room_mm{};  ///< per point: the eye's bound where it is below `eye_mm`;
                                        ///< empty where it never is
    std::span<const double> turn_room_per_mm{};  ///< per point: how much the laid fibre may turn
                                                 ///< against the plan per mm; empty: no bound
    std::span<const double> share{};  ///< per point, 0..1: part of all these tolerances that blocks
                                      ///< through the point may use; empty: 1
};

struct BlockChoice {
    /// Points that are block ends, ascending: the first, the last of every piece, and those that
    /// the tolerance needs between. So no block runs over the end of a piece.
    std::vector<std::size_t> ends;
    /// One per end: length that counts for the fibre's speed in the block that ends there. It is
    /// the fibre laid, or drawn through the eye, if the whole block ran as its fastest place; mm, 0
    /// for the first.
    std::vector<double> fibre_mm;
    /// Largest of each over all blocks; only blocks of a single step exceed the tolerance.
    double worst_sideways_mm = 0.0;  ///< |y|
    double worst_angle_rad = 0.0;    ///< |dy/ds|
    double worst_pull_mm = 0.0;      ///< |delta|
    double worst_eye_mm = 0.0;
    double worst_twist_rad = 0.0;
    double worst_turn_per_mm = 0.0;  ///< |d2y/ds2|, over kTurnLength_mm
    std::size_t beyond = 0;          ///< steps of the dense path that do not keep the tolerance
};

/// Takes the longest block from each end on, by galloping and bisection, checked at the joints of
/// as many places as there are dense points in it and between these; a single step is a block in
/// any case. The free length stays within the machine's limits.
/// Accuracy: tests/postproc/motion/choose_blocks_test.cpp holds the tolerance by an independent
/// measure.
[[nodiscard]] BlockChoice choose_blocks(const Machine& machine, const BlockTask& task,
                                        const BlockTolerance& tolerance);

/// The path with further points (fibre_curve.h) where a single step, moved linearly by the joints
/// of the policy, would pull sideways by more than `sideways_mm` or break the rest of the
/// tolerance. Points between two stations have the number of the first; behind a joint of two
/// pieces that of the next piece's first. Steps in which the eye moves less than kFinestStep_mm are
/// left as they are: a wrist that flips does not get better by cutting. The first point of a piece
/// is left out where it repeats the last of the piece before.
[[nodiscard]] EyePath refine_path(const Machine& machine, const EyePath& path,
                                  RedundancyPolicy policy, const BlockTolerance& tolerance);

inline constexpr double kFinestStep_mm = 0.5;

/// Turns of the laid fibre are taken over at least this length: the fibre is a band.
inline constexpr double kTurnLength_mm = 3.0;

/// The chosen points alone.
[[nodiscard]] EyePath points_at(const EyePath& path, std::span<const std::size_t> ends);
[[nodiscard]] JointPath points_at(const JointPath& joints, std::span<const std::size_t> ends);

}  // namespace meshwind
