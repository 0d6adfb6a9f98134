/// Blocks of a motion and their time: what blocks may take up, more time where the fibre would run
/// too fast, and which limit it is that binds.
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

/// What blocks are chosen by, per job.
/// \param most_mm fibre of a block at most \param finer share of the tolerances that blocks may
/// take up
[[nodiscard]] BlockTolerance block_tolerance(
    const Job& job, double most_mm = std::numeric_limits<double>::infinity(), double finer = 1.0);

/// The speed that the fibre is planned with: the job's, or what of the machine's is safe.
[[nodiscard]] double planned_speed_mm_s(const Setup& setup);

/// Per point of a path, how far the eye may be off it between the ends of blocks.
/// \param clearance_mm of the head, one per point
[[nodiscard]] std::vector<double> room_of_clearance_mm(const Setup& setup,
                                                       std::span<const Piece> pieces,
                                                       const EyePath& path,
                                                       std::vector<double> clearance_mm);

/// What blocks may take up at each point of a path.
struct BlockBounds {
    std::vector<double> share;   ///< of the tolerance, 0..1
    std::vector<double> longer;  ///< of the time that the fibre takes at its full speed, >= 1
    double most_mm = std::numeric_limits<double>::infinity();  ///< fibre of a block
};

/// Blocks as the controller runs them.
struct ProgramBlocks {
    BlockChoice choice;
    BlockList list;        ///< what the program runs, repeated circuits included
    BlockList exact;       ///< the ends that were chosen, rounded to nothing but 1e-9 mm or deg
    ProgramLayout layout;  ///< how they are written
    std::vector<BindingLimit> binding;
    double duration_s = 0.0;  ///< starting from rest and stopping, corner_s of it
    double corner_s = 0.0;    ///< what the controller adds at corners
};

/// Blocks for a motion, their time law, and what the controller's language makes of them. A
/// controller that slows down at corners runs shorter ones faster, for they turn less from one to
/// the next: where that pays they are shorter.
/// \param room_mm per point: how far the eye may be off
[[nodiscard]] ProgramBlocks program_blocks(const Setup& setup, std::span<const Piece> pieces,
                                           const AxisPath& axes, std::span<const double> room_mm,
                                           const BlockBounds& bounds);

/// Gives more time to the stretches of a path on which the fibre ran too fast.
/// \param fast blocks in ascending order, of `blocks`
/// \param longer per point of the path: share of the time at the fibre's full speed, >= 1; those of
/// the blocks grow
void lengthen(std::span<const FastBlock> fast, const std::vector<Block>& blocks,
              const EyePath& path, std::vector<double>& longer);

/// Asks for finer blocks where the simulation found some too coarse; false where it found none.
/// \param coarse blocks in ascending order, of `blocks`
/// \param share per point of the path: of the tolerance; those of the blocks shrink
bool tighten(std::span<const std::size_t> coarse, const std::vector<Block>& blocks,
             const EyePath& path, std::vector<double>& share);

/// Fibre of each block as its speed counts it: longer than it is where it takes more time.
[[nodiscard]] std::vector<double> counted_fibre_mm(const BlockChoice& choice,
                                                   std::span<const double> longer);

/// Numbers limits by the blocks that a controller gets, which may need two for one step.
/// \param blocks ends of all steps are among theirs
void renumber(std::vector<BindingLimit>& binding, const BlockList& steps, const BlockList& blocks);

}  // namespace meshwind
