/// Constraints on the pattern of a layer, and the search for the best pattern that meets them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "winding/revolution/pattern.h"

namespace meshwind {

/// An open lattice instead of a closed wall: ribs of either hand, evenly spaced.
struct LatticeConstraints {
    int circuits = 6;  ///< >= 1: ribs of one hand
    int series = 1;    ///< >= 0: bands side by side in a rib; 0 fills the gaps between ribs
    int plies = 1;     ///< >= 1: how often all of it is wound, band upon band
};

/// Values left out are free.
struct PatternConstraints {
    std::int64_t circuits = 0;  ///< > 0: this N
    std::int64_t starts = 0;    ///< > 0: this pattern number
    std::optional<BandOrder> order{};
    /// >= 0: how much bands overlap at most, as a share of their distance; 0.25 when left out, and
    /// any where `circuits` are given.
    std::optional<double> most_overlap{};
    double least_dwell_rad = 0.0;            ///< >= 0: at each rim that the fibre turns over
    std::optional<double> most_dwell_rad{};  ///< >= least: at each rim; any when left out
    /// > 0: distance of neighbouring bands' middles across the bands, at the widest place; 0: the
    /// tow's width. Smaller ones overlap, larger ones leave gaps.
    double band_offset_mm = 0.0;
};

/// Figures of a body's circuits that determine their pattern.
struct CircuitToClose {
    double turn_rad = 0.0;         ///< of the mandrel in a circuit, without dwell
    double most_change_rad = 0.0;  ///< largest change of the circuit itself
    int dwelling_ends = 0;         ///< 0 .. 2: ends at which the fibre can dwell
    double band_mm = 6.0;          ///< > 0: width of the tow
    double mm_per_rad = 1.0;       ///< > 0: across the bands, R cos(alpha) where it is most
    int layers = 1;                ///< >= 1
};

struct FoundPattern {
    std::optional<Pattern> pattern{};  ///< its overlap is that of the tow
    std::string failure;  ///< without a pattern: what cannot be met, and what nearly can
};

/// The pattern with the figures of the circuit's bands at their own width, whatever distance they
/// were asked to have.
[[nodiscard]] Pattern with_bands_of(const CircuitToClose& circuit, Pattern pattern);

/// The best pattern by find_patterns() that fulfils the wish. Dwell is the same at both ends where
/// there are two. Where none fulfils it, `failure` lists up to five that miss as few of the wishes
/// as possible, the nearest first. \throws InputError as find_patterns()
[[nodiscard]] FoundPattern find_wished_pattern(const CircuitToClose& circuit,
                                               const PatternConstraints& wish);

/// The pattern of an open lattice; that of the least dwell where the wish leaves a choice, as by
/// lattice(). `wish.circuits` and `wish.most_overlap` are not read. Fails where the bands of a rib
/// would meet those of the next. \pre circuit.layers == 1 \throws InputError as find_patterns()
[[nodiscard]] FoundPattern find_wished_lattice(const CircuitToClose& circuit,
                                               const LatticeConstraints& lattice,
                                               const PatternConstraints& wish);

/// Bands and ribs of a pattern found by find_wished_lattice(). Those that fill their gaps are
/// spread evenly over them (fill_lattice(), Series::even_rad).
[[nodiscard]] LaidLattice laid_lattice(const Pattern& pattern, const CircuitToClose& circuit,
                                       const LatticeConstraints& lattice,
                                       const PatternConstraints& wish);

/// Start of each circuit in winding order, from the first one, >= 0: circuit i of a pattern at
/// place i K mod N; with a lattice the N of them once for each series, an offset further on, and
/// all of that once for each ply.
[[nodiscard]] std::vector<double> circuit_starts_rad(const Pattern& pattern,
                                                     const std::optional<LaidLattice>& lattice);

/// Interlacing of N circuits whose passes wind by `pass_rad` and turn over the upper end by
/// `upper_turn_rad`. On the parallel where the way up has wound by f, circuits p and q places apart
/// cross when 2 f = (q - p) 2 pi / N + 2 pass + turn (mod 2 pi); a later circuit lies on top, and
/// the way back on the way up. Ends do not count. \param pass_rad > 0 \param upper_turn_rad >= 0
[[nodiscard]] Interlacing interlacing_of(const Pattern& pattern, double pass_rad,
                                         double upper_turn_rad);

}  // namespace meshwind
