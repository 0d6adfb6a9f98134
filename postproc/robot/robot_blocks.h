/// Collects the moves of a robot's program that is being read into blocks.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "machines/machine.h"
#include "postproc/motion/block.h"
#include "postproc/nc/nc_reader.h"

namespace meshwind {

/// A move to absolute positions.
struct RobotMove {
    std::vector<std::int64_t> nano{};  ///< by entries of the joint vector
    double duration_s = 0.0;           ///< of a block; 0: the move leads to the start
    bool stops = false;                ///< at its end, so that the next begins from rest
    std::int32_t piece = -1;           ///< by the last course mark
    std::int32_t line = 0;
};

/// The list, and the line that is being read. Moves to the start come first, then the stop for the
/// fibre, then blocks.
class RobotBlocks {
public:
    /// \param file name used in messages, which outlives this \param time_word of the language, in
    /// messages
    RobotBlocks(std::string_view text, const std::string& file, const Machine& machine,
                std::string time_word);

    /// The line that is being read, where messages point.
    [[nodiscard]] NcLine& line() { return line_; }
    [[nodiscard]] const std::vector<BlockAxis>& axes() const { return list_.axes; }
    /// Whether a comment has tied the fibre on or placed pins.
    [[nodiscard]] bool ties_on() const { return list_.tie_on_mm || !list_.pins.empty(); }

    /// \throws InputError nc.tie_on, nc.pins
    void comment(std::string_view words, std::int32_t number);
    void stop(std::int32_t number);
    /// A move that is to be filled in, with all axes at 0, of the piece that was marked last.
    [[nodiscard]] RobotMove next(std::int32_t number) const;
    /// \throws InputError nc.resolution, nc.too_far, nc.rapid, nc.too_many_lines; of a block
    /// nc.unknown_start, nc.feed, nc.stop_point
    void move(RobotMove to);

    /// \throws InputError nc.no_motion
    [[nodiscard]] BlockList take();

private:
    void approach(const RobotMove& to);
    void block(const RobotMove& to);
    void check_place(const RobotMove& to) const;

    NcLine line_;
    std::string time_word_;
    NcMarks marks_;
    BlockList list_;
    std::vector<std::int64_t> place_;  // of the last move
    std::int32_t stop_point_ = 0;      // line of the last block, when it ends at rest
};

}  // namespace meshwind
