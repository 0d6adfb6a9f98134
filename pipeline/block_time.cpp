#include "pipeline/block_time.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshwind {
namespace {

// More time is given in steps of this, so that circuits that repeat stay the same.
constexpr double kLongerStep = 1e-3;

}  // namespace

void lengthen(std::span<const FastBlock> fast, const std::vector<Block>& blocks,
              const EyePath& path, std::vector<double>& longer) {
    const auto key = [](const auto& at) { return std::pair(at.piece, at.point); };
    std::size_t point = 0;
    for (const FastBlock& one : fast) {
        const double factor = 1.0 + kLongerStep * std::ceil((one.ratio - 1.0) / kLongerStep);
        const auto from = key(blocks[one.block > 0 ? one.block - 1 : 0]);
        const auto to = key(blocks[one.block]);
        while (point < path.size() && key(path[point]) <= from) {
            ++point;
        }
        for (; point < path.size() && key(path[point]) <= to; ++point) {
            longer[point] *= factor;
        }
    }
}

std::vector<double> counted_fibre_mm(const BlockChoice& choice, std::span<const double> longer) {
    std::vector<double> counted = choice.fibre_mm;
    for (std::size_t i = 1; i < choice.ends.size(); ++i) {
        const auto first = longer.begin() + static_cast<std::ptrdiff_t>(choice.ends[i - 1]) + 1;
        const auto last = longer.begin() + static_cast<std::ptrdiff_t>(choice.ends[i]) + 1;
        counted[i] *= *std::max_element(first, last);
    }
    return counted;
}

void renumber(std::vector<BindingLimit>& binding, const BlockList& steps, const BlockList& blocks) {
    std::vector<std::size_t> block_of;
    std::size_t block = 0;
    for (std::size_t i = 0; i < steps.blocks.size(); ++i, ++block) {
        while (!std::ranges::equal(blocks.row(block), steps.row(i))) {
            ++block;
        }
        block_of.push_back(block);
    }
    for (BindingLimit& limit : binding) {
        for (BindingStretch& stretch : limit.stretches) {
            stretch.first = block_of[stretch.first - 1] + 1;
            stretch.last = block_of[stretch.last];
        }
    }
}

}  // namespace meshwind
