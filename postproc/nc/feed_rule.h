/// Feed rules: the length that a feed per minute counts when linear and rotary axes move together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "postproc/motion/block.h"

namespace meshwind {

enum class FeedRule {
    Nist,    ///< X Y Z alone; U V W when those rest; else A B C in degrees
    Euclid,  ///< all axes, a degree as a millimetre
};

/// Lengths of a move by groups of letters, mm or deg, whatever the machine has on a letter.
struct MoveLengths {
    double main = 0.0;    ///< X Y Z
    double second = 0.0;  ///< U V W and what is not named here
    double rotary = 0.0;  ///< A B C

    /// Linear length for the rule Nist: X Y Z, or the second group when those rest.
    [[nodiscard]] double linear() const { return main > 0.0 ? main : second; }
};

[[nodiscard]] MoveLengths move_lengths(std::span<const BlockAxis> axes,
                                       std::span<const std::int64_t> from,
                                       std::span<const std::int64_t> to);

/// The length whose quotient by the time is F.
[[nodiscard]] double feed_length(FeedRule rule, const MoveLengths& lengths);

/// Time of a rapid move with the fibre on: as fast as the slowest of the axes can, without ramps.
[[nodiscard]] double rapid_time_s(const Machine& machine, std::span<const std::int64_t> from,
                                  std::span<const std::int64_t> to);

/// Bounds below which a block with a tiny linear part beside its turn would be run too fast under
/// the rule Nist.
struct SlowLinear {
    double least_feed_mm_min = 0.0;  ///< below it, where rotary axes turn besides; 0: never
    double split_feed_mm_min = 0.0;  ///< feed of the part that has the whole linear move
    /// Linear moves of fewer steps are rounded too much to carry a feed of less than half of
    /// split_feed_mm_min; 0: no such bound.
    double short_steps = 0.0;
};

[[nodiscard]] bool has_slow_linear(const BlockList& list, const SlowLinear& rule);

/// Splits such blocks into one with the whole linear move and its share of the turn, and one that
/// only turns: same positions, same time. Idempotent: the result has no such block left.
[[nodiscard]] BlockList split_slow_linear(BlockList list, const SlowLinear& rule);

}  // namespace meshwind
