/// Block lists with known contents, for tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "machines/machine.h"
#include "postproc/motion/block.h"

namespace meshwind::test {

/// machines/six_axis.json: C Z Y X A B.
[[nodiscard]] Machine six_axis();

/// machines/robot_winder.json: X of the spindle, A B C U V W of the arm.
[[nodiscard]] Machine robot_winder();

/// The machine's axes and no block.
[[nodiscard]] BlockList empty_list(const Machine& machine);

/// Appends a block at an absolute position in steps of each axis.
void add(BlockList& list, const std::vector<std::int64_t>& steps, double duration_s, int piece = 0);

/// A start and n blocks, each moving some axes.
[[nodiscard]] BlockList random_list(const Machine& machine, unsigned seed, int n);

/// The text with the comment, in its first line but "%", that makes it one of ours. \param opens
/// what opens a comment, "(" or ";"
[[nodiscard]] std::string as_ours(std::string text, char opens = '(');

/// A program of n lines for LinuxCNC as others write them: G90 and G91, mm and inches, G92, rapid
/// moves with the fibre on, codes that move nothing, six decimals, no axis placed before.
[[nodiscard]] std::string foreign_program(const Machine& machine, unsigned seed, int n);

/// Circuits of a carriage (Z) that goes there and back, X and A with it, `length` blocks each
/// (even,
/// >= 4), while the mandrel (C) turns by `advance_deg` a circuit; positions rounded as make_blocks
/// does. `lead` blocks of irregular motion before and after.
struct PatternOptions {
    int circuits = 233;
    int length = 40;
    double advance_deg = 1234.56789;
    int lead = 7;
};
[[nodiscard]] BlockList pattern(const Machine& machine, const PatternOptions& options);

}  // namespace meshwind::test
