/// Finds closed winding patterns by arithmetic, without meshes: the number of circuits and the
/// dwell with which the bands close around the mandrel, and the order of the bands.
///
/// A **circuit** leads to one end, to the other and back to its reference circle. With the turn T
/// of the mandrel per circuit, N circuits close after K whole turns when N T = 2 pi K. For N and K
/// without a common factor the bands then lie 2 pi / N apart, one at each place; circuit i lies at
/// place i K mod N. See docs/winding.md, "Patterns".
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "winding/plan/details.h"

namespace meshwind {

/// Closures that are off by less than this per circuit count as exact: far below the step of any
/// axis (0.001 deg is 1.7e-5 rad), far above the rounding of turns in closed form.
inline constexpr double kSameTurn_rad = 1e-9;

/// Request for a pattern.
struct PatternRequest {
    double circuit_rad = 0.0;      ///< >= 0, any size: turn per circuit without dwell
    double band_rad = 0.0;         ///< > 0: the band around the circle, width / (R cos(alpha))
    double most_dwell_rad = 0.0;   ///< >= 0: may be added per circuit, for both ends together
    double most_change_rad = 0.0;  ///< >= 0: largest change of `circuit_rad` itself, either way
    /// >= 1: bands over each other, in each of both directions, when the pattern closes. The bands
    /// of all layers are spaced evenly; a pattern for 1 wound twice puts band upon band instead.
    int layers = 1;
    double least_overlap = 0.0;        ///< > -1: share of the band; below 0 gaps are allowed
    double most_overlap = 0.1;         ///< >= least; the least N is tried even where it has more
    int wanted_starts = 0;             ///< >= 0: equally good patterns are ranked by nearness to it
    int most_patterns = 100;           ///< > 0: only the best, at most this many
    double least_dwell_rad = 0.0;      ///< 0 .. most_dwell_rad: always added per circuit
    std::int64_t circuits = 0;         ///< > 0: only this N, however much its bands overlap or gape
    std::int64_t starts = 0;           ///< > 0: only patterns of this many starts
    std::optional<BandOrder> order{};  ///< only these; N <= 2 is both

    /// \throws InputError pattern.out_of_range, pattern.band_too_narrow
    void validate() const;
};

/// All patterns that close with the dwell and change allowed, leading and lagging ones; the best
/// first, at most `most_patterns`. Best is the least |overlap|, by whole percents; then no gap;
/// then the least dwell and change, in steps of 5 degrees; then the number of starts nearest to the
/// wish. Patterns equal so far are ranked by the exact overlap, then by dwell and change, then by
/// K.
/// \return empty where nothing closes
/// \throws InputError as validate()
/// Sources: N T = 2 pi K is andrianov_2022_machine_path, eq. (5) to (7), for any N; leading and
/// lagging patterns are those of koussios_2004_filament.
[[nodiscard]] std::vector<Pattern> find_patterns(const PatternRequest& request);

/// The open lattice of `circuits` bands, evenly spaced: that of the least dwell. Its turn is the
/// smallest 2 pi m / N >= circuit with gcd(m, N) = 1, so `dwell_rad / 2` is the compensation angle
/// Phi_f of andrianov_2022_machine_path, eq. (7), and turn_rad mod 2 pi the accepted pitch Phi_p.
/// `overlap` is negative: -1 plus the share that bands cover. \param circuits > 0
/// \throws InputError pattern.out_of_range
[[nodiscard]] Pattern lattice(double circuit_rad, int circuits, double band_rad);

/// A wall closed by filling each gap of a lattice with bands side by side: the lattice again and
/// again, each time further by `offset_rad`. Source: andrianov_2022_machine_path, sec. 2.2.
struct Series {
    std::int64_t count = 0;     ///< lattices: ceil(gap / band), 9 = ceil(60 / 7.09) there
    double offset_rad = 0.0;    ///< between them: the band, Phi_w of eq. (8)
    double overlap = 0.0;       ///< of the last lattice over the first
    double even_rad = 0.0;      ///< the offset that spreads this overlap over all, gap / count
    double total_rad = 0.0;     ///< of the mandrel; an offset after each lattice
    std::int64_t circuits = 0;  ///< in all
};

/// \param band_rad > 0 \throws InputError pattern.out_of_range
[[nodiscard]] Series fill_lattice(const Pattern& lattice, double band_rad);

/// Circuits in the order in which their bands lie around the mandrel, from circuit 0 on: entry p is
/// the circuit at place p, p K^-1 mod N.
[[nodiscard]] std::vector<std::int64_t> circuits_around(const Pattern& pattern);

/// Resolution of a mandrel axis as a ratio of whole numbers, so that sums are exact: counted in any
/// unit, as 360 000 per turn and 1 per step for 0.001 degrees.
struct AxisStep {
    std::int64_t units_per_turn = 360'000;  ///< 1 .. 1e12
    std::int64_t units_per_step = 1;        ///< 1 .. units_per_turn
};

/// Effect of rounding to steps on a pattern.
struct StepClosure {
    std::vector<std::int64_t> increments;  ///< N: from circuit to circuit, differences of the
                                           ///< rounded sums
    /// Error of their sum from K turns: 0 where a step divides the turn, else at most half a step.
    double closure_rad = 0.0;
    double worst_rad = 0.0;  ///< largest error of any circuit's place, at most half a step
    /// Error of the sum if each increment were rounded by itself: up to N / 2 steps.
    double separate_rad = 0.0;
};

/// \throws InputError pattern.out_of_range
[[nodiscard]] StepClosure closure_in_steps(const Pattern& pattern, const AxisStep& step);

}  // namespace meshwind
