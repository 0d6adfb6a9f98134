#include "postproc/verify/check_finding.h"

#include <algorithm>

#include "core/text/text_number.h"

namespace meshwind {
namespace {

// Samples of one block follow one another.
void append_new(std::vector<std::size_t>& blocks, std::size_t block) {
    if (blocks.empty() || blocks.back() != block) {
        blocks.push_back(block);
    }
}

}  // namespace

void CheckFinding::fail(std::size_t block, const std::string& words) {
    check.ok = false;
    check.words = words;
    add_wrong(block);
    first_wrong_block = std::min(block, first_wrong_block.value_or(block));
}

void CheckFinding::add_wrong(std::size_t block) {
    append_new(wrong_blocks, block);
}

void CheckFinding::add_finer(std::size_t block) {
    append_new(coarse_blocks, block);
}

void CheckFinding::add_coarse(std::size_t block) {
    add_wrong(block);
    add_finer(block);
}

void put_at_station(Check& check, const LaidPath& laid, std::size_t station) {
    check.place = {.position_mm = laid.path[station].position_mm, .block = laid.at[station].block};
}

void put_at_sample(Check& check, const LaidPath& laid, std::size_t sample) {
    check.place = {.position_mm = laid.samples[sample].landing_mm, .block = laid.block[sample]};
}

void put_at_block(Check& check, const LaidPath& laid, std::size_t block) {
    const std::vector<std::size_t>& blocks = laid.block;
    if (!blocks.empty()) {
        const auto at = std::lower_bound(blocks.begin(), blocks.end(), block);
        const auto sample = static_cast<std::size_t>(at - blocks.begin());
        put_at_sample(check, laid, std::min(sample, blocks.size() - 1));
        check.place->block = block;
    }
}

std::string place_words(const Eigen::Vector3d& position_mm) {
    const Eigen::Vector3d& p = position_mm;
    return " at (" + fixed(p.x(), 1) + ", " + fixed(p.y(), 1) + ", " + fixed(p.z(), 1) + ")";
}

}  // namespace meshwind
