/// Dry run of a program in the air: the same increments, from a start so far out that nothing can
/// meet the part.
#pragma once

#include <string>

#include "pipeline/setup.h"
#include "pipeline/verify_text.h"
#include "postproc/motion/block.h"

namespace meshwind {

struct DryRun {
    std::string text;
    BlockList blocks;       ///< as read from the text
    char axis = '?';        ///< axis that starts elsewhere
    double moved_mm = 0.0;  ///< shift of its start, with sign
};

/// A linear axis across the spindle starts farther out, so that in every block the head stays
/// `clearance_mm` off the mandrel, its extensions and all bodies; from there on the axes move as in
/// the program. Time, speeds and the controller's words stay as they are.
/// \param clearance_mm > 0 \throws InputError as verify_text(); dry_run.no_axis where there is no
/// such axis, dry_run.no_room where its travel does not reach
[[nodiscard]] DryRun dry_run(Setup setup, const VerifyInputs& inputs, double clearance_mm);

}  // namespace meshwind
