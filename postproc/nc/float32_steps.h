/// Position errors of controllers that add increments up in 32-bit floats, and axis steps without
/// such errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "postproc/motion/block.h"
#include "postproc/nc/nc_flavour.h"

namespace meshwind {

/// 2^-9 mm or deg, the finest power of two that nine decimals write exactly.
inline constexpr std::int64_t kFinestBinary_nano = kNanoPerUnit / 512;

/// 2^-4: coarser steps are no remedy, an axis that asks for them is refused. With them it may reach
/// 1 048 576 mm or deg.
inline constexpr int kCoarsestBinary = 4;

/// Largest error of the controller against the written positions when it reads each increment of an
/// axis and adds it in floats, beginning with the start; mm or deg.
[[nodiscard]] double float32_error(const BlockList& list, std::size_t axis, Float32Text text);

/// Axes that float sums would take off their positions by more than half a step, and by more than
/// half the new step, get a step that is a power of two: 2^-finest_binary, or as much coarser as
/// their reach and the digits of their longest move need. Multiples of it have sums that are exact
/// in 24 bits, so the remainders are carried and nothing drifts. Blocks that then move no axis are
/// merged with the next. \throws InputError dialect.float32 when an axis goes beyond what its
/// coarsest steps reach
[[nodiscard]] BlockList with_binary_steps(BlockList list, const NcFlavour& flavour);

/// Splits blocks evenly whose increments still have more digits than the controller reads.
/// Idempotent.
[[nodiscard]] BlockList split_long_numbers(BlockList list, std::size_t most_digits);

/// Gives axes that are not on multiples of their step the largest power of two that they are on.
void set_binary_steps(BlockList& list);

}  // namespace meshwind
