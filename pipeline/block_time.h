/// Time of blocks: more of it where the fibre would run too fast, and which limit it is that binds.
#pragma once

#include <span>
#include <vector>

#include "postproc/eye/eye_path.h"
#include "postproc/motion/block.h"
#include "postproc/motion/choose_blocks.h"
#include "postproc/motion/time_law.h"
#include "postproc/verify/verify.h"

namespace meshwind {

/// Gives more time to the stretches of a path on which the fibre ran too fast.
/// \param fast blocks in ascending order, of `blocks`
/// \param longer per point of the path: share of the time at the fibre's full speed, >= 1; those of
/// the blocks grow
void lengthen(std::span<const FastBlock> fast, const std::vector<Block>& blocks,
              const EyePath& path, std::vector<double>& longer);

/// Fibre of each block as its speed counts it: longer than it is where it takes more time.
[[nodiscard]] std::vector<double> counted_fibre_mm(const BlockChoice& choice,
                                                   std::span<const double> longer);

/// Numbers limits by the blocks that a controller gets, which may need two for one step.
/// \param blocks ends of all steps are among theirs
void renumber(std::vector<BindingLimit>& binding, const BlockList& steps, const BlockList& blocks);

}  // namespace meshwind
