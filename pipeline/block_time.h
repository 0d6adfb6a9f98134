/// Blocks of a motion and their time law: block tolerances, slower stretches where the fibre would
/// run too fast, and the binding limits.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "pipeline/setup.h"
#include "postproc/collision/clear_motion.h"
#include "postproc/eye/eye_path.h"
#include "postproc/motion/block.h"
#include "postproc/motion/choose_blocks.h"
#include "postproc/motion/time_law.h"
#include "postproc/nc/repeats.h"
#include "postproc/verify/verify.h"
#include "winding/plan/plan.h"

namespace meshwind {

/// Tolerances by which blocks are chosen, per job.
/// \param most_mm largest fibre length of a block \param finer share of the tolerances that blocks
/// may take up
[[nodiscard]] BlockTolerance block_tolerance(
    const Job& job, double most_mm = std::numeric_limits<double>::infinity(), double finer = 1.0);

/// Planned fibre speed: the job's, limited to the safe part of the machine's.
[[nodiscard]] double planned_speed_mm_s(const Setup& setup);

/// Allowed distance of the eye from each point of a path, between the ends of blocks.
/// \param clearance_mm of the head, one per point
[[nodiscard]] std::vector<double> room_of_clearance_mm(const Setup& setup,
                                                       std::span<const Piece> pieces,
                                                       const EyePath& path,
                                                       std::vector<double> clearance_mm);

/// Limits of blocks at each point of a path.
struct BlockBounds {
    std::vector<double> share;   ///< of the tolerance, 0..1
    std::vector<double> longer;  ///< factor on the fibre's time at its full speed, >= 1
    double most_mm = std::numeric_limits<double>::infinity();  ///< fibre of a block
};

/// Blocks as the controller runs them.
struct ProgramBlocks {
    BlockChoice choice;
    BlockList list;        ///< blocks that the program runs, repeated circuits included
    BlockList exact;       ///< the chosen ends, rounded only to 1e-9 mm or deg
    ProgramLayout layout;  ///< how they are written
    std::vector<BindingLimit> binding;
    double duration_s = 0.0;  ///< starting from rest and stopping, corner_s of it
    double corner_s = 0.0;    ///< added by the controller at corners
};

/// Blocks for a motion, their time law and their layout in the controller's language. A controller
/// that slows down at corners runs shorter blocks faster, since they turn less from one to the
/// next: blocks are made shorter where that saves time.
/// \param room_mm per point: allowed distance of the eye from it
[[nodiscard]] ProgramBlocks program_blocks(const Setup& setup, std::span<const Piece> pieces,
                                           const AxisPath& axes, std::span<const double> room_mm,
                                           const BlockBounds& bounds);

/// Gives more time to the stretches of a path on which the fibre ran too fast.
/// \param fast blocks in ascending order, of `blocks`
/// \param longer per point of the path: factor on the time at the fibre's full speed, >= 1; those
/// of the blocks grow
void lengthen(std::span<const FastBlock> fast, const std::vector<Block>& blocks,
              const EyePath& path, std::vector<double>& longer);

/// Asks for finer blocks where the simulation found some too coarse; false where it found none.
/// \param coarse blocks in ascending order, of `blocks`
/// \param share per point of the path: of the tolerance; those of the blocks shrink
bool tighten(std::span<const std::size_t> coarse, const std::vector<Block>& blocks,
             const EyePath& path, std::vector<double>& share);

/// Fibre length of each block as counted for its speed: longer than the true one where it takes
/// more time.
[[nodiscard]] std::vector<double> counted_fibre_mm(const BlockChoice& choice,
                                                   std::span<const double> longer);

/// Renumbers limits by the blocks of the controller, which may need two for one step.
/// \param blocks ends of all steps are among theirs
void renumber(std::vector<BindingLimit>& binding, const BlockList& steps, const BlockList& blocks);

}  // namespace meshwind
