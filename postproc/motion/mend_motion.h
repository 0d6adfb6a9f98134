/// Collision-free motion of least time: chosen, checked, and mended where it is not clear.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "postproc/motion/optimal_motion.h"

namespace meshwind {

/// The motion of a program under improvement. Keeps the first motion: it stays where no better one
/// is clear.
class MotionImprover {
public:
    /// \param safe a motion that works, with its turns \param ahead_mm as in OptimalMotionTask
    MotionImprover(const Machine& machine, const RayQuery& obstacles, const FreeFibreRule& rule,
                   double fibre_speed_mm_s, bool fixed_lengths, EyePath safe,
                   std::vector<double> ahead_mm);

    /// Chooses the motion of least time by what is known so far (optimal_motion.h).
    void choose();

    /// Chooses anew about stations at which a check failed, with more clearance; after kMendings
    /// tries, puts the first motion back there, over twice as much fibre where that did not help.
    /// \param stations in any order \return false where all of it has been put back already
    bool mend(std::span<const std::size_t> stations);

    /// Puts the first motion back about stations at which fibre is laid wrongly: more clearance is
    /// no cure. \return false where all of it has been put back already
    bool give_up(std::span<const std::size_t> stations);

    [[nodiscard]] const EyePath& path() const { return path_; }

    /// First and last stations of the stretches that were chosen last.
    [[nodiscard]] const std::vector<std::pair<std::size_t, std::size_t>>& changed() const {
        return changed_;
    }

private:
    void optimise(std::span<const char> free, bool mending);
    /// Marks the stations that are put back about one. False where all of the path was already.
    bool mark_back(std::size_t station, double reach_mm, std::vector<char>& marks) const;
    using Range = std::pair<std::size_t, std::size_t>;
    /// First and last station within `reach_mm` of fibre of one.
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

/// A place is mended this many times before it is given up.
inline constexpr int kMendings = 4;

}  // namespace meshwind
