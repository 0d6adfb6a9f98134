/// A check on a program that was wound again, and the blocks at which it fails.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "postproc/verify/check.h"
#include "postproc/verify/laydown.h"

namespace meshwind {

struct CheckFinding {
    explicit CheckFinding(const CheckKind& kind) : check(kind) {}
    explicit CheckFinding(Check made) : check(std::move(made)) {}

    /// The check fails at a block, which stands in the words.
    void fail(std::size_t block, const std::string& words);

    void add_wrong(std::size_t block);
    /// A block to be made finer, for one that is wrong; it may be right itself.
    void add_finer(std::size_t block);
    /// A wrong block in which finer ones may help.
    void add_coarse(std::size_t block);

    Check check;
    std::optional<std::size_t> first_wrong_block{};  ///< the first at which the check fails
    std::vector<std::size_t> wrong_blocks{};         ///< in any order, some more than once
    std::vector<std::size_t> coarse_blocks{};        ///< to be made finer, in any order as well
};

/// The check's place becomes that of a station of the laid fibre.
void put_at_station(Check& check, const LaidPath& laid, std::size_t station);

/// The check's place becomes where the fibre lands at a sample.
void put_at_sample(Check& check, const LaidPath& laid, std::size_t sample);

/// The check's place becomes where the fibre lands while a block runs; samples end where the fibre
/// cannot be followed. Without samples the place stays as it is.
void put_at_block(Check& check, const LaidPath& laid, std::size_t block);

/// " at (1.0, 2.0, 3.0)".
[[nodiscard]] std::string place_words(const Eigen::Vector3d& position_mm);

}  // namespace meshwind
