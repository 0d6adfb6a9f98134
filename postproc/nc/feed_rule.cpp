#include "postproc/nc/feed_rule.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/units.h"

namespace meshwind {
namespace {

constexpr double kSecondsPerMinute = 60.0;

bool is_rotary(char letter) {
    return letter >= 'A' && letter <= 'C';
}

MoveLengths lengths_of(const BlockList& list, std::size_t block) {
    return move_lengths(list.axes, list.row(block - 1), list.row(block));
}

// The largest step of a linear axis that moves.
double step_mm(const BlockList& list, std::size_t block) {
    std::int64_t step = 0;
    for (std::size_t a = 0; a < list.axes.size(); ++a) {
        if (!is_rotary(list.axes[a].letter) && list.row(block)[a] != list.row(block - 1)[a]) {
            step = std::max(step, list.axes[a].resolution_nano);
        }
    }
    return static_cast<double>(step) / static_cast<double>(kNanoPerUnit);
}

bool needs_split(const BlockList& list, std::size_t block, const SlowLinear& rule) {
    const MoveLengths lengths = lengths_of(list, block);
    const double linear = lengths.linear();
    if (!(linear > 0.0 && lengths.rotary > 0.0)) {
        return false;
    }
    const double duration_s = list.blocks[block].duration_s;
    return linear * kSecondsPerMinute < rule.least_feed_mm_min * duration_s ||
           (linear * kSecondsPerMinute < 0.5 * rule.split_feed_mm_min * duration_s &&
            linear < rule.short_steps * step_mm(list, block));
}

std::vector<std::size_t> blocks_to_split(const BlockList& list, const SlowLinear& rule) {
    std::vector<std::size_t> found;
    for (std::size_t i = 1; i < list.blocks.size(); ++i) {
        if (needs_split(list, i, rule)) {
            found.push_back(i);
        }
    }
    return found;
}

void append_block(BlockList& to, const Block& block, std::span<const std::int64_t> row) {
    to.blocks.push_back(block);
    to.nano.insert(to.nano.end(), row.begin(), row.end());
}

// Whole linear move with its share of the turn, then the rest of the turn.
void append_split(BlockList& to, const BlockList& from, std::size_t block, const SlowLinear& rule) {
    Block first = from.blocks[block];
    Block second = first;
    first.duration_s =
        lengths_of(from, block).linear() * kSecondsPerMinute / rule.split_feed_mm_min;
    second.duration_s -= first.duration_s;
    const double share = first.duration_s / from.blocks[block].duration_s;
    std::vector<std::int64_t> row(from.row(block).begin(), from.row(block).end());
    for (std::size_t a = 0; a < row.size(); ++a) {
        if (is_rotary(from.axes[a].letter)) {
            const std::int64_t before = from.row(block - 1)[a];
            const std::int64_t steps = (row[a] - before) / from.axes[a].resolution_nano;
            // Towards zero, so that something is left to turn in the second block.
            row[a] = before + static_cast<std::int64_t>(share * static_cast<double>(steps)) *
                                  from.axes[a].resolution_nano;
        }
    }
    append_block(to, first, row);
    append_block(to, second, from.row(block));
}

}  // namespace

MoveLengths move_lengths(std::span<const BlockAxis> axes, std::span<const std::int64_t> from,
                         std::span<const std::int64_t> to) {
    MoveLengths squares;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        const double move =
            static_cast<double>(to[a] - from[a]) / static_cast<double>(kNanoPerUnit);
        (is_rotary(axes[a].letter) ? squares.rotary
         : axes[a].letter >= 'X'   ? squares.main
                                   : squares.second) += move * move;
    }
    return {std::sqrt(squares.main), std::sqrt(squares.second), std::sqrt(squares.rotary)};
}

double feed_length(FeedRule rule, const MoveLengths& lengths) {
    if (rule == FeedRule::Euclid) {
        return std::hypot(lengths.main, lengths.second, lengths.rotary);
    }
    return lengths.linear() > 0.0 ? lengths.linear() : lengths.rotary;
}

double rapid_time_s(const Machine& machine, std::span<const std::int64_t> from,
                    std::span<const std::int64_t> to) {
    double longest_s = 0.0;
    for (std::size_t a = 0; a < from.size(); ++a) {
        const double way =
            std::abs(static_cast<double>(to[a] - from[a])) / static_cast<double>(kNanoPerUnit);
        const Axis& axis = machine.axis(a);
        const bool rotary = axis.type == AxisType::Rotary;
        longest_s = std::max(longest_s, (rotary ? rad_from_deg(way) : way) / axis.velocity);
    }
    return longest_s;
}

bool has_slow_linear(const BlockList& list, const SlowLinear& rule) {
    return !blocks_to_split(list, rule).empty();
}

BlockList split_slow_linear(BlockList list, const SlowLinear& rule) {
    const std::vector<std::size_t> split = blocks_to_split(list, rule);
    if (split.empty()) {
        return list;
    }
    BlockList result;
    result.axes = list.axes;
    result.tie_on_mm = list.tie_on_mm;
    result.blocks.reserve(list.blocks.size() + split.size());
    result.nano.reserve(list.nano.size() + split.size() * list.axes.size());
    auto next = split.begin();
    for (std::size_t i = 0; i < list.blocks.size(); ++i) {
        if (next != split.end() && *next == i) {
            append_split(result, list, i, rule);
            ++next;
        } else {
            append_block(result, list.blocks[i], list.row(i));
        }
    }
    return result;
}

}  // namespace meshwind
