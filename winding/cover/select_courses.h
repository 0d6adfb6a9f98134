/// Selects courses from the library that cover everything in reach, evenly and with little fibre.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "winding/laminate/stage_ask.h"
#include "winding/plan/course.h"

namespace meshwind {

struct SelectOptions {
    int target_layers = 1;  ///< each reachable sample is to be covered at least this often
    /// The same per sample, below 0 where more than enough lies; empty: `target_layers` everywhere.
    std::span<const std::int32_t> targets{};
    /// Cost of a sample already covered, against the gain of a new one: fibre laid over fibre is
    /// wasted and makes the wall uneven.
    double overlap_weight = 0.35;
    /// Cost of fibre off the wanted winding angle, against 1 for a layer too many.
    double angle_weight = 4.0;

    [[nodiscard]] std::int32_t target(std::int32_t sample) const {
        return targets.empty() ? target_layers : targets[static_cast<std::size_t>(sample)];
    }
};

/// Which members are laid, and how often each coverage sample is covered by them.
struct Selection {
    std::vector<std::int32_t> chosen;  ///< indices of members, in the order of choice
    std::vector<std::int32_t> layers;  ///< per sample
};

/// Share of the samples in reach that are short of their target. \param layers per sample
/// \param reached per sample
[[nodiscard]] double lacking_share(std::span<const std::int32_t> layers,
                                   std::span<const char> reached, const SelectOptions& options);

/// Members that bring most samples to their target, per length of their fibre, until at most the
/// share `most_short` of those in reach is short of it, or no member helps. \param reached per
/// sample
/// \param layers per sample, laid already \return members, each once
[[nodiscard]] std::vector<std::int32_t> fill_thin_places(std::span<const LibraryCourse> members,
                                                         std::span<const char> allowed,
                                                         std::span<const char> reached,
                                                         std::vector<std::int32_t> layers,
                                                         const SelectOptions& options,
                                                         double most_short);

/// Courses to begin with, each the way that it is wound.
struct FirstChoice {
    std::vector<DirectedCourse> courses;
    std::optional<double> least_fibre_mm;  ///< as in Plan
};

/// Tells of courses whether they hold; called for some of them repeatedly.
using Holding = std::function<std::vector<char>(std::span<const DirectedCourse>)>;

/// Chooses whole courses for a stage's share of the fractional solution with the least fibre for
/// the rest of the wall (winding/bound/); none after the last stage. Where some do not hold, the
/// fractions are found again without them, a few times. No bound of fibre where an angle is wanted.
/// \param reached per sample \param nodes 2 for each rim
[[nodiscard]] FirstChoice choose_first(std::span<const LibraryCourse> members,
                                       std::span<const char> allowed, std::span<const char> reached,
                                       std::span<const Eigen::Vector3d> position_mm,
                                       std::size_t nodes, const SelectOptions& options,
                                       const StageAsk& stage, const Holding& hold);

}  // namespace meshwind
