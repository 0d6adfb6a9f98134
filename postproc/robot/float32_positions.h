/// Absolute positions as a controller holds them that keeps each in a 32-bit float. They are
/// rounded one by one, so that nothing adds up (float32_steps.h has controllers that add).
#pragma once

#include <string>
#include <vector>

#include "postproc/motion/block.h"

namespace meshwind {

/// \throws InputError dialect.float32 when an axis goes so far that its positions are as coarse as
/// the coarsest steps of controllers that add in floats, as beyond 1 048 576 mm or deg
/// \param controller in messages
void check_float32(const BlockList& list, const std::string& controller);

/// A remark for each axis whose positions the controller rounds by more than half a step.
[[nodiscard]] std::vector<std::string> float32_notes(const BlockList& list);

}  // namespace meshwind
