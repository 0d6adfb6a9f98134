/// A motion of least time that is clear: chosen, checked, and mended where it is not.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "postproc/motion/optimal_motion.h"

namespace meshwind {

/// The motion of a program under improvement. Keeps the one that it began with: where nothing
/// better is clear, that one stays.
class MotionImprover {
public:
    /// \param safe a motion that works, with its turns \param ahead_mm as in OptimalMotionTask
    MotionImprover(const Machine& machine, const RayQuery& obstacles, const FreeFibreRule& rule,
                   double fibre_speed_mm_s, bool fixed_lengths, EyePath safe,
                   std::vector<double> ahead_mm);

    /// The motion of least time by what is known (optimal_motion.h).
    void choose();

    /// Chooses anew about stations at which a check failed, with more clearance; where that has
    /// been tried kMendings times already, the motion that it began with is put back, over twice as
    /// much fibre where that did not help.
    /// \param stations in any order \return false where all of it has been put back already
    bool mend(std::span<const std::size_t> stations);

    /// Puts the motion that it began with back about stations at which fibre is not laid as it
    /// should be: more clearance is no cure. \return false where all of it has been put back
    /// already
    bool give_up(std::span<const std::size_t> stations);

    [[nodiscard]] const EyePath& path() const { return path_; }

    /// First and last stations of what was chosen last.
    [[nodiscard]] const std::vector<std::pair<std::size_t, std::size_t>>& changed() const {
        return changed_;
    }

private:
    void optimise(std::span<const char> free, bool mending);
    /// Marks what is put back about a station. False where all of the path was already.
    bool mark_back(std::size_t station, double reach_mm, std::vector<char>& marks) const;
    using Range = std::pair<std::size_t, std::size_t>;
    /// First and last station no further from one than so much fibre.
    [[nodiscard]] Range about(std::size_t station, double reach_mm) const;
    void mark(std::size_t station, double reach_mm, std::vector<char>& marks) const;
    void put_back(const std::vector<char>& marks, std::vector<char>& changed);
    void note_changes(const std::vector<char>& changed);

    const Machine& machine_;
    const RayQuery& obstacles_;
    FreeFibreRule rule_;
    double fibre_speed_mm_s_;
    bool fixed_lengths_;
    EyePath safe_;
    EyePath path_;
    std::vector<double> ahead_mm_;
    std::vector<double> more_mm_;
    std::vector<int> tries_;      ///< per station
    std::vector<char> given_up_;  ///< per station
    std::vector<std::pair<std::size_t, std::size_t>> changed_;
};

/// A place is mended so many times before it is given up.
inline constexpr int kMendings = 4;

}  // namespace meshwind
