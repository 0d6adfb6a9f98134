/// The neutral program as a list of blocks: written by every dialect, returned by every reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "machines/machine.h"
#include "postproc/eye/eye_path.h"
#include "postproc/motion/joint_path.h"
#include "postproc/motion/program_head.h"
#include "postproc/motion/time_law.h"
#include "winding/plan/turns.h"

namespace meshwind {

/// Nano units per mm or degree: positions are integers of 1e-9 mm or deg, so that sums are exact.
inline constexpr std::int64_t kNanoPerUnit = 1'000'000'000;

struct BlockAxis {
    char letter = '?';
    AxisType type = AxisType::Linear;
    std::int64_t resolution_nano = 1;  ///< positions of this axis are multiples of it

    friend bool operator==(const BlockAxis&, const BlockAxis&) = default;
};

/// One line of motion; all axes arrive together after its duration.
struct Block {
    double duration_s = 0.0;
    std::int32_t piece = -1;  ///< course or transition in winding order; -1 unknown
    std::int32_t point = -1;  ///< landing point within the piece at the block's end; -1 unknown
    std::int32_t line = 0;    ///< line of the file it was read from, from 1; 0 when planned.
                              ///< Blocks that a program repeats share their line
};

/// Blocks with the absolute axis positions at their ends. Block 0 is the start position, which the
/// machine takes before the fibre is tied on; its duration is 0.
struct BlockList {
    std::vector<BlockAxis> axes;     ///< in the order of the machine's joint vector
    std::vector<Block> blocks;       ///< n
    std::vector<std::int64_t> nano;  ///< n x axes by rows: absolute, 1e-9 mm or 1e-9 deg
    /// Tie-on point of the fibre, mandrel frame, from the program's head; unset without one, and in
    /// a list that was planned.
    std::optional<Eigen::Vector3d> tie_on_mm{};
    /// Pins on which the fibre turns, from the head; none in a list that was planned.
    std::vector<PinRing> pins{};
    /// Everything else in a program's text; unset in a list that was planned.
    std::optional<ProgramHead> head{};

    [[nodiscard]] std::span<const std::int64_t> row(std::size_t block) const {
        return {nano.data() + block * axes.size(), axes.size()};
    }
    /// Absolute position in output units: mm or **deg**.
    [[nodiscard]] double value(std::size_t block, std::size_t axis) const {
        return static_cast<double>(nano[block * axes.size() + axis]) /
               static_cast<double>(kNanoPerUnit);
    }
    [[nodiscard]] double duration_s() const;
    /// Blocks that move, for messages: the number of the last one; the start position is none.
    [[nodiscard]] std::size_t moves() const { return blocks.empty() ? 0 : blocks.size() - 1; }
};

/// Absolute position of block `block` as a joint vector (mm, rad).
[[nodiscard]] std::vector<double> joints_at(const BlockList& list, std::size_t block);

/// The positions of all blocks.
[[nodiscard]] JointPath joint_path(const BlockList& list);

/// "block 17 (line 40)"; without the line where it is unknown.
[[nodiscard]] std::string block_words(const BlockList& list, std::size_t block);

/// Largest motion of one block: more turns than the longest stroke of the narrowest tow winds (10 m
/// at 0.5 mm), and a longer way than any bed. A number beyond has lost its decimal point, and
/// winding it again would take hours.
inline constexpr double kMaxBlock_deg = 20'000 * 360.0;
inline constexpr double kMaxBlock_mm = 100'000.0;

/// Words when an axis goes further than that from one position to the next; else empty.
[[nodiscard]] std::string beyond_one_block(const BlockAxis& axis, std::int64_t from_nano,
                                           std::int64_t to_nano);

/// The machine with other steps. \pre steps has an entry for each axis, in the joints' order
[[nodiscard]] Machine with_steps(Machine machine, std::span<const BlockAxis> steps);

/// A program's blocks and the time law of their durations.
struct TimedBlocks {
    BlockList list;
    TimedPath time;  ///< a step per block; list has its durations
};

/// Rounds the absolute positions to each axis' resolution, so that the sum of increments stays
/// within half a step of the plan over any number of blocks. Steps that move no axis by a whole
/// step are merged into the next one that does, with their fibre; at the end into the last. The
/// time law is that of the rounded positions, which the machine runs.
/// \param fibre_mm per point, length that counts for the fibre's speed (time_path)
/// \pre path, joints and fibre_mm have equal length
/// \throws InputError block.too_far beyond +-4e9 mm or deg; what time_path throws
[[nodiscard]] TimedBlocks make_blocks(const Machine& machine, const EyePath& path,
                                      const JointPath& joints, std::span<const double> fibre_mm,
                                      const TimeLawOptions& options = {});

/// Decimals that print every multiple of the resolution exactly, 0..9.
[[nodiscard]] int decimals_of(std::int64_t resolution_nano);

}  // namespace meshwind
