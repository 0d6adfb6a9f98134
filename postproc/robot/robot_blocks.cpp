#include "postproc/robot/robot_blocks.h"

#include <utility>

#include "core/interrupt.h"
#include "postproc/nc/foreign_notes.h"
#include "postproc/nc/program_flow.h"

namespace meshwind {
namespace {

// Blocks are read between two looks at whether an end is asked for: some milliseconds.
constexpr std::size_t kBlocksPerLook = 4096;

// A program needs one move to get to its start.
constexpr std::size_t kMaxApproaches = 1000;

}  // namespace

RobotBlocks::RobotBlocks(std::string_view text, const std::string& file, const Machine& machine,
                         std::string time_word)
    : time_word_(std::move(time_word)) {
    line_.file = &file;
    for (std::size_t a = 0; a < machine.axis_count(); ++a) {
        const Axis& axis = machine.axis(a);
        list_.axes.push_back({axis.letter, axis.type, axis.resolution_nano});
    }
    ProgramHead& head = list_.head.emplace();
    head.has_approach = true;
    head.by_meshwind = is_by_meshwind(lines_of_text(text));
}

void RobotBlocks::comment(std::string_view words, std::int32_t number) {
    const std::int32_t now = std::exchange(line_.number, number);
    line_.comments.assign(1, words);
    marks_.read(line_, list_);
    line_.number = now;
}

void RobotBlocks::stop(std::int32_t number) {
    if (list_.blocks.empty()) {
        list_.head->stop_line = number;
    }
}

RobotMove RobotBlocks::next(std::int32_t number) const {
    return {.nano = std::vector<std::int64_t>(list_.axes.size(), 0),
            .piece = marks_.piece(),
            .line = number};
}

void RobotBlocks::move(RobotMove to) {
    const std::int32_t now = std::exchange(line_.number, to.line);
    if (to.duration_s > 0.0) {
        block(to);
    } else {
        approach(to);
    }
    place_ = std::move(to.nano);
    line_.number = now;
}

void RobotBlocks::approach(const RobotMove& to) {
    if (!list_.blocks.empty()) {
        line_.fail("nc.rapid", "a move without " + time_word_ +
                                   " after the first block has no time of its own; write it");
    }
    ProgramHead& head = *list_.head;
    if (head.approach.size() == kMaxApproaches) {
        line_.fail("nc.too_many_lines", "more than " + std::to_string(kMaxApproaches) +
                                            " moves lead to the start; leave some out");
    }
    check_place(to);
    const std::vector<bool> all(to.nano.size(), true);
    head.approach.push_back({to.nano, all, all, to.line});
    head.stop_line = 0;
}

void RobotBlocks::block(const RobotMove& to) {
    if (place_.empty()) {
        line_.fail("nc.unknown_start",
                   "the first move has a time and comes from nowhere; begin with a move to the "
                   "start without " +
                       time_word_);
    }
    if (stop_point_ != 0) {
        line_.number = stop_point_;
        line_.fail("nc.stop_point",
                   "the block ends at rest and another follows; the fibre would stop there: let "
                   "the robot fly by");
    }
    if (list_.blocks.empty()) {
        list_.blocks.push_back({.piece = to.piece, .line = to.line});
        list_.nano = place_;
    }
    if (to.nano == place_) {
        line_.fail("nc.feed", "the block moves no axis, so that it lasts no time; remove it");
    }
    check_place(to);
    if (static_cast<std::int64_t>(list_.blocks.size()) > kMaxLinesRun) {
        line_.fail("nc.too_many_lines", "more than " + std::to_string(kMaxLinesRun) +
                                            " blocks are not read; split the program");
    }
    if (list_.blocks.size() % kBlocksPerLook == 0) {
        check_interrupt();
    }
    stop_point_ = to.stops ? to.line : 0;
    list_.blocks.push_back({.duration_s = to.duration_s, .piece = to.piece, .line = to.line});
    list_.nano.insert(list_.nano.end(), to.nano.begin(), to.nano.end());
}

void RobotBlocks::check_place(const RobotMove& to) const {
    for (std::size_t a = 0; a < to.nano.size(); ++a) {
        const BlockAxis& axis = list_.axes[a];
        if (to.nano[a] % axis.resolution_nano != 0) {
            line_.fail("nc.resolution", std::string("the position of ") + axis.letter +
                                            " is not a multiple of the axis' resolution");
        }
        const std::int64_t from = place_.empty() ? to.nano[a] : place_[a];
        if (const std::string words = beyond_one_block(axis, from, to.nano[a]); !words.empty()) {
            line_.fail("nc.too_far", words);
        }
    }
}

BlockList RobotBlocks::take() {
    if (list_.blocks.size() < 2) {
        line_.fail("nc.no_motion",
                   "the program has no move with " + time_word_ + "; there is nothing to wind");
    }
    return std::move(list_);
}

}  // namespace meshwind
