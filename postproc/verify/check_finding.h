/// Result of a check on a program that was wound again, with the blocks at which it fails.
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

    /// The check fails at a block, which the words name.
    void fail(std::size_t block, const std::string& words);

    void add_wrong(std::size_t block);
    /// A block to be made finer because of a wrong one; it may be right itself.
    void add_finer(std::size_t block);
    /// A wrong block for which finer ones may help.
    void add_coarse(std::size_t block);

    Check check;
    std::optional<std::size_t> first_wrong_block{};  ///< the first at which the check fails
    std::vector<std::size_t> wrong_blocks{};         ///< in any order, some more than once
    std::vector<std::size_t> coarse_blocks{};        ///< to be made finer, in any order as well
};

/// Sets the check's place to a station of the laid fibre.
void put_at_station(Check& check, const LaidPath& laid, std::size_t station);

/// Sets the check's place to the landing point at a sample.
void put_at_sample(Check& check, const LaidPath& laid, std::size_t sample);

/// Sets the check's place to the landing point while a block runs; samples end where the fibre
/// cannot be followed. Without samples the place stays as it is.
void put_at_block(Check& check, const LaidPath& laid, std::size_t block);

/// " at (1.0, 2.0, 3.0)".
[[nodiscard]] std::string place_words(const Eigen::Vector3d& position_mm);

}  // namespace meshwind
